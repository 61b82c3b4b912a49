//! Modules by path.

use crate::{
    ShaderError,
    comments::{BiasLine, Comments},
    locate, near, slots, source,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// The folder whose modules are passes.
pub const PASSES: &str = "pass";

/// WGSL modules by path: `base/math` is the file `base/math.wgsl`.
#[derive(Clone, Debug, Default)]
pub struct Library {
    modules: BTreeMap<String, Module>,
    facts: Option<BTreeSet<String>>,
}

#[derive(Clone, Debug)]
pub(crate) struct Module {
    pub text: String,
    /// The text without its comments.
    pub code: String,
    /// What it declares.
    pub declared: BTreeSet<String>,
    /// How messages name it: a file's path, or the module path with `.wgsl`.
    pub origin: String,
}

impl Library {
    /// An empty library.
    pub fn new() -> Self {
        Self::default()
    }

    /// Says which names a scene's facts have: `@if` and `@needs` with others are faults from now on.
    pub fn know_facts(&mut self, names: &[&str]) {
        self.facts = Some(names.iter().map(|&name| name.to_owned()).collect());
    }

    pub(crate) fn facts(&self) -> Option<&BTreeSet<String>> {
        self.facts.as_ref()
    }

    /// Adds or replaces one module; `origin` is what messages call it.
    pub fn insert(&mut self, path: impl Into<String>, text: impl Into<String>, origin: impl Into<String>) {
        let (text, origin) = (text.into(), origin.into());
        let code = source::code(&text);
        let names = source::declarations(&code).into_iter().map(|one| one.name);
        let declared = names.filter(|name| !name.is_empty()).map(str::to_owned).collect();
        self.modules.insert(path.into(), Module { text, code, declared, origin });
    }

    /// Adds every `*.wgsl` below `folder`, over modules of the same path.
    ///
    /// # Errors
    /// [`ShaderError::Read`] names what cannot be read, [`ShaderError::NoShaders`] a folder of which nothing would be used.
    pub fn add_folder(&mut self, folder: &Path) -> Result<(), ShaderError> {
        let mut found = Below::default();
        found.read(folder, "")?;
        if let Some(why) = self.misplaced(folder, &found) {
            return Err(ShaderError::NoShaders { folder: folder.display().to_string(), why });
        }
        found.files.into_iter().for_each(|(path, text, origin)| self.insert(path, text, origin));
        Ok(())
    }

    /// Why nobody would look for what lies in a folder.
    fn misplaced(&self, folder: &Path, found: &Below) -> Option<String> {
        if found.tops.iter().any(|name| self.looks_for(name)) {
            return None;
        }
        let paths = || found.files.iter().map(|(path, ..)| path.as_str());
        let why = if let Some(name) = paths().find(|path| !path.contains('/')) {
            format!("`{name}.wgsl` lies directly in the folder, where nothing looks for it: passes lie in `{PASSES}/`")
        } else if let Some(path) = paths().find(|path| path.contains(&format!("/{PASSES}/"))) {
            format!("`{path}.wgsl` lies too deep: passes lie in `{PASSES}/`, directly in the folder")
        } else if found.files.is_empty() {
            format!("no shader lies in the folder: passes are `{PASSES}/NAME.wgsl`")
        } else {
            return None;
        };
        let above = folder.file_name().and_then(|name| name.to_str()).filter(|name| self.looks_for(name)).and_then(|_| folder.parent());
        let cure = above.filter(|above| *above != Path::new("")).map(|above| format!("; did you mean `{}`?", above.display()));
        Some(why + &cure.unwrap_or_default())
    }

    /// Some module has a path that begins so, or is asked for under such a path.
    fn looks_for(&self, top: &str) -> bool {
        let asked = format!("package::{top}::");
        let within = |path: &String| path.strip_prefix(top).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        top == PASSES
            || self.modules.keys().any(within)
            || self.modules.values().any(|module| module.code.contains(&asked) || slots::mentioned(&module.code).contains(top))
    }

    /// A fault in what stands above a declaration (`taps`, `Params.exposure`): at that tag, else at the declaration, else in the file.
    pub fn fault(&self, module: &str, name: &str, tag: Option<&str>, message: String) -> ShaderError {
        let text = self.text(module).unwrap_or_default();
        match Comments::read(text).line_of(name, tag) {
            Some(line) => {
                let start = text.split_inclusive('\n').take(line).map(str::len).sum::<usize>();
                let indent = text[start..].len() - text[start..].trim_start().len();
                locate::at(self, module, start + indent, message)
            }
            None => locate::file(self, module, message),
        }
    }

    /// Paths of the modules in `folder`, without the folder (`pass` → `gbuffer_traced`, `path_tracer`, …).
    pub fn modules(&self, folder: &str) -> Vec<String> {
        let inside = |path: &String| path.strip_prefix(folder)?.strip_prefix('/').map(str::to_owned);
        self.modules.keys().filter_map(inside).collect()
    }

    /// Every path.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.modules.keys().map(String::as_str)
    }

    /// The text of one module.
    pub fn text(&self, path: &str) -> Option<&str> {
        self.modules.get(path).map(|module| module.text.as_str())
    }

    /// The manual page of one module: the `//!` text at its head, without tags.
    pub fn manual(&self, path: &str) -> Option<String> {
        Some(Comments::read(self.text(path)?).manual)
    }

    /// The `//! bias` lines at the head of one module.
    pub fn bias(&self, path: &str) -> Vec<BiasLine> {
        self.text(path).map(|text| Comments::read(text).bias).unwrap_or_default()
    }

    /// Every slot that some module imports, with the modules of its folder: what can fill it.
    pub fn slots(&self) -> BTreeMap<String, Vec<String>> {
        let names: BTreeSet<&str> = self.modules.values().flat_map(|module| slots::mentioned(&module.text)).collect();
        names.into_iter().map(|slot| (slot.to_owned(), self.modules(slot))).collect()
    }

    /// What fills a slot that nothing is said of: the module of its folder whose head has a line `//! @default`.
    pub fn default_slots(&self) -> BTreeMap<String, String> {
        let is_default = |slot: &str, filling: &str| {
            let text = self.text(&slots::module_of(slot, filling)).unwrap_or_default();
            text.lines().filter_map(|line| line.trim().strip_prefix("//!")).any(|line| line.trim_start() == "@default")
        };
        let slots = self.slots().into_iter();
        slots
            .filter_map(|(slot, fillings)| Some((slot.clone(), fillings.into_iter().find(|filling| is_default(&slot, filling))?)))
            .collect()
    }

    pub(crate) fn module(&self, path: &str) -> Result<&Module, ShaderError> {
        self.modules.get(path).ok_or_else(|| ShaderError::NoModule { path: path.to_owned(), nearest: self.nearest(path) })
    }

    fn nearest(&self, path: &str) -> Option<String> {
        near::nearest(path, self.paths()).map(str::to_owned)
    }
}

/// The shaders below a folder.
#[derive(Default)]
struct Below {
    /// Module path, text and file.
    files: Vec<(String, String, String)>,
    /// Names of folders and shaders directly in it.
    tops: Vec<String>,
}

impl Below {
    fn read(&mut self, folder: &Path, prefix: &str) -> Result<(), ShaderError> {
        let fault = |path: &Path, why: std::io::Error| ShaderError::Read { path: path.display().to_string(), why: why.to_string() };
        for entry in fs::read_dir(folder).map_err(|why| fault(folder, why))? {
            let path = entry.map_err(|why| fault(folder, why))?.path();
            let Some(stem) = path.file_stem().and_then(|stem| stem.to_str()) else { continue };
            let is_shader = path.extension().is_some_and(|extension| extension == "wgsl");
            if prefix.is_empty() && (is_shader || path.is_dir()) {
                self.tops.push(stem.to_owned());
            }
            if path.is_dir() {
                self.read(&path, &format!("{prefix}{stem}/"))?;
            } else if is_shader {
                let text = fs::read_to_string(&path).map_err(|why| fault(&path, why))?;
                self.files.push((format!("{prefix}{stem}"), text, path.display().to_string()));
            }
        }
        Ok(())
    }
}
