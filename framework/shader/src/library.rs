//! Modules by path.

use crate::{
    ShaderError,
    comments::{BiasLine, Comments},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// WGSL modules by path: `base/math` is the file `base/math.wgsl`.
#[derive(Clone, Debug, Default)]
pub struct Library {
    modules: BTreeMap<String, Module>,
}

#[derive(Clone, Debug)]
pub(crate) struct Module {
    pub text: String,
    /// How messages name it: a file's path, or the module path with `.wgsl`.
    pub origin: String,
}

impl Library {
    /// An empty library.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds or replaces one module; `origin` is what messages call it.
    pub fn insert(&mut self, path: impl Into<String>, text: impl Into<String>, origin: impl Into<String>) {
        self.modules.insert(path.into(), Module { text: text.into(), origin: origin.into() });
    }

    /// Adds every `*.wgsl` below `folder`, over modules of the same path.
    ///
    /// # Errors
    /// [`ShaderError::Read`] names the file or folder that cannot be read.
    pub fn add_folder(&mut self, folder: &Path) -> Result<(), ShaderError> {
        self.add_below(folder, "")
    }

    fn add_below(&mut self, folder: &Path, prefix: &str) -> Result<(), ShaderError> {
        let fault = |path: &Path, why: std::io::Error| ShaderError::Read { path: path.display().to_string(), why: why.to_string() };
        for entry in fs::read_dir(folder).map_err(|why| fault(folder, why))? {
            let path = entry.map_err(|why| fault(folder, why))?.path();
            let Some(stem) = path.file_stem().and_then(|stem| stem.to_str()) else { continue };
            if path.is_dir() {
                self.add_below(&path, &format!("{prefix}{stem}/"))?;
            } else if path.extension().is_some_and(|extension| extension == "wgsl") {
                let text = fs::read_to_string(&path).map_err(|why| fault(&path, why))?;
                self.insert(format!("{prefix}{stem}"), text, path.display().to_string());
            }
        }
        Ok(())
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
        let names: BTreeSet<&str> = self.modules.values().flat_map(|module| crate::slots::mentioned(&module.text)).collect();
        names.into_iter().map(|slot| (slot.to_owned(), self.modules(slot))).collect()
    }

    /// What fills a slot that nothing is said of: the module of its folder whose head has a line `//! @default`.
    pub fn default_slots(&self) -> BTreeMap<String, String> {
        let is_default = |slot: &str, filling: &str| {
            let text = self.text(&crate::slots::module_of(slot, filling)).unwrap_or_default();
            text.lines().any(|line| line.trim_end() == "//! @default")
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
        let scored = self.modules.keys().map(|known| (strsim::jaro_winkler(known, path), known));
        scored.filter(|(score, _)| *score > 0.8).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, known)| known.clone())
    }
}
