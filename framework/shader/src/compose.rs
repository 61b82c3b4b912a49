//! One entry module, linked with what it imports: text, naga module, interface.

use crate::{Cut, Interface, Library, ShaderError, cuts, facts, imports, locate, reflect, slots};
use std::{
    borrow::Cow,
    cell::RefCell,
    collections::{BTreeMap, BTreeSet},
};
use wesl::{
    CompileOptions, Diagnostic, Feature, Features, Mangler, ResolveError, Resolver,
    syntax::{ModulePath, PathOrigin},
};

/// Which shader, with what in its slots, for which facts of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Specialisation {
    /// Module path of the entry file, e.g. `pass/temporal`.
    pub entry: String,
    /// Slot → filling, e.g. `domain` → `di`. Slots that the shader does not reach may be named.
    pub slots: BTreeMap<String, String>,
    /// Names that `@if(name)` finds true.
    pub features: BTreeSet<String>,
}

/// A shader ready for a device.
#[derive(Clone, Debug)]
pub struct Composed {
    /// Validated, with final binding numbers.
    pub module: naga::Module,
    /// What it asks of its host.
    pub interface: Interface,
    /// The linked WGSL, for people; binding numbers are those of the sources.
    pub text: String,
    /// What the facts of the scene left out.
    pub cuts: Vec<Cut>,
}

impl Library {
    /// Links, validates and reflects one shader.
    ///
    /// # Errors
    /// See [`ShaderError`]; positions are those of the source files.
    pub fn compose(&self, what: &Specialisation) -> Result<Composed, ShaderError> {
        self.module(&what.entry)?;
        let linker = Linker { library: self, slots: &what.slots, reached: RefCell::default(), fault: RefCell::default() };
        let linked = linker.link(what);
        // Faults in what modules say of each other make faults in the linked text, which only tell of the consequence.
        for module in linker.reached.into_inner() {
            facts::check(self, &module)?;
            imports::check(self, what, &module)?;
        }
        let (text, modules) = linked?;
        let mut module = naga::front::wgsl::parse_str(&text).map_err(|error| {
            let offset = error.location(&text).map(|place| place.offset as usize);
            locate::linked(self, &what.entry, &text, offset, error.message())
        })?;
        if module.entry_points.is_empty() {
            let why = "there is no entry point: what runs is a function with `@compute @workgroup_size(8, 8)` before its `fn`";
            return Err(locate::file(self, &what.entry, why.to_owned()));
        }
        reflect::check_bindings(self, &what.entry, &module)?;
        reflect::number_bindings(&mut module);
        let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
            .validate(&module)
            .map_err(|error| locate::invalid(self, &what.entry, &text, &error))?;
        let interface = reflect::interface(self, what, &module, &info, &modules)?;
        let texts = modules.iter().filter_map(|path| Some((path, self.text(path)?)));
        let cuts = texts.flat_map(|(path, text)| cuts::of(path, text, &what.features)).collect();
        Ok(Composed { module, interface, text, cuts })
    }
}

fn module_path(path: &str) -> ModulePath {
    ModulePath::new(PathOrigin::Absolute, path.split('/').map(str::to_owned).collect())
}

/// Gives WESL the library's modules, slots filled.
struct Linker<'a> {
    library: &'a Library,
    slots: &'a BTreeMap<String, String>,
    /// Modules that the linker asked for.
    reached: RefCell<Vec<String>>,
    /// Our own error, which would lose its type on the way through WESL's.
    fault: RefCell<Option<ShaderError>>,
}

impl Linker<'_> {
    /// The linked text and the paths of the modules that it came from.
    fn link(&self, what: &Specialisation) -> Result<(String, Vec<String>), ShaderError> {
        let flags = what.features.iter().map(|name| (name.clone(), Feature::Enable)).collect();
        let options =
            CompileOptions { validate: false, features: Features { default: Feature::Disable, flags }, ..CompileOptions::default() };
        let result = wesl::compile_sourcemap(&module_path(&what.entry), self, &Names, &options);
        match (self.fault.take(), result) {
            (Some(fault), _) => Err(fault),
            (None, Err(error)) => Err(self.refused(&what.entry, error)),
            (None, Ok(linked)) => {
                let modules = linked.modules.iter().map(|path| path.components.join("/")).collect();
                Ok((linked.to_string(), modules))
            }
        }
    }

    /// WESL's error as ours; without a module of its own it is the entry's.
    fn refused(&self, entry: &str, error: wesl::Error) -> ShaderError {
        let Diagnostic { error, detail } = Diagnostic::from(error);
        let message = match *error {
            wesl::Error::ParseError(fault) => fault.error.to_string(),
            other => other.to_string(),
        };
        let module = detail.module_path.map_or_else(|| entry.to_owned(), |path| path.components.join("/"));
        match (detail.span, detail.source) {
            (Some(span), Some(text)) => locate::filled(self.library, &module, &text, span.start, message),
            _ => locate::file(self.library, &module, message),
        }
    }

    fn refuse(&self, path: &ModulePath, error: ShaderError) -> ResolveError {
        let message = error.to_string();
        self.fault.borrow_mut().get_or_insert(error);
        ResolveError::ModuleNotFound(path.clone(), message)
    }
}

impl Resolver for Linker<'_> {
    fn resolve_source<'b>(&'b self, path: &ModulePath) -> Result<Cow<'b, str>, ResolveError> {
        let name = path.components.join("/");
        let text = self.library.module(&name).and_then(|module| slots::fill(&module.text, &name, self.slots));
        let text = text.map_err(|error| self.refuse(path, error))?;
        self.reached.borrow_mut().push(name);
        Ok(Cow::Owned(text))
    }
}

/// `base/math`'s `PI` becomes `base__math__PI`: readable, and undone by [`unmangle`].
#[derive(Clone, Copy, Debug)]
struct Names;

const SEPARATOR: &str = "__";

impl Mangler for Names {
    fn mangle(&self, path: &ModulePath, item: &str) -> String {
        let mut name = path.components.join(SEPARATOR);
        name.push_str(SEPARATOR);
        name.push_str(item);
        name
    }

    fn unmangle(&self, mangled: &str) -> Option<(ModulePath, String)> {
        let (path, item) = unmangle(mangled)?;
        Some((module_path(&path), item))
    }
}

/// Module path and item of a linked name; `None` for a name of the entry module, which keeps its own.
pub(crate) fn unmangle(name: &str) -> Option<(String, String)> {
    let (path, item) = name.rsplit_once(SEPARATOR)?;
    (!path.is_empty() && !item.is_empty()).then(|| (path.replace(SEPARATOR, "/"), item.to_owned()))
}
