//! From a naga module to an [`Interface`].

use crate::{
    BiasNote, Binding, Entry, Interface, Layout, Library, Member, Output, Override, ResourceKind, Scalar, ShaderError, Specialisation,
    Stage,
    comments::{BiasLine, Comments},
    compose::unmangle,
    locate, slots,
};
use naga::{AddressSpace, Handle, ScalarKind, StorageAccess, TypeInner, common::wgsl::TypeContext, proc::Layouter, valid::GlobalUse};
use std::collections::BTreeMap;

/// Refuses groups that no host fills, and two variables of one module with the same numbers.
pub fn check_bindings(library: &Library, entry: &str, module: &naga::Module) -> Result<(), ShaderError> {
    let mut taken = BTreeMap::new();
    for (_, variable) in module.global_variables.iter() {
        let Some(naga::ResourceBinding { group, binding }) = variable.binding else { continue };
        let linked = variable.name.as_deref().unwrap_or_default();
        let (path, name) = unmangle(linked).unwrap_or_else(|| (entry.to_owned(), linked.to_owned()));
        if group > 1 {
            let why =
                format!("nothing fills group {group} of `{name}`: group 0 is the frame's and the scene's, group 1 has ports and `params`");
            return Err(locate::declaration(library, &path, &name, why));
        }
        if let Some(other) = taken.insert((path.clone(), group, binding), name.clone()) {
            let why = format!("`{name}` has the group and binding of `{other}`: numbers of one file must differ");
            return Err(locate::declaration(library, &path, &name, why));
        }
    }
    Ok(())
}

/// Gives the bindings of each group dense numbers in order of declaration.
pub fn number_bindings(module: &mut naga::Module) {
    let mut next = BTreeMap::<u32, u32>::new();
    for (_, variable) in module.global_variables.iter_mut() {
        if let Some(binding) = &mut variable.binding {
            let number = next.entry(binding.group).or_default();
            binding.binding = *number;
            *number += 1;
        }
    }
}

/// Everything the host must know.
pub fn interface(
    library: &Library,
    what: &Specialisation,
    module: &naga::Module,
    info: &naga::valid::ModuleInfo,
    modules: &[String],
) -> Result<Interface, ShaderError> {
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).map_err(|error| locate::file(library, &what.entry, error.to_string()))?;
    let comments: BTreeMap<&str, Comments> =
        modules.iter().filter_map(|path| Some((path.as_str(), Comments::read(library.text(path)?)))).collect();
    let reader = Reader { library, what, module, layouter, comments };
    let (bindings, handles) = reader.bindings(info)?;
    Ok(Interface {
        needs: reader.comments.get(what.entry.as_str()).map(|comments| comments.needs.clone()).unwrap_or_default(),
        paths: reader.comments.values().filter_map(|comments| comments.paths.clone()).collect(),
        manual: reader.comments.get(what.entry.as_str()).map(|comments| comments.manual.clone()).unwrap_or_default(),
        entries: reader.entries(info, &handles),
        bindings,
        overrides: reader.overrides()?,
        slots: reached_slots(library, what, modules),
        bias: reader.bias(),
    })
}

/// Slots that the linked modules import.
fn reached_slots(library: &Library, what: &Specialisation, modules: &[String]) -> Vec<(String, String)> {
    let texts = modules.iter().filter_map(|path| library.text(path));
    let names: std::collections::BTreeSet<&str> = texts.flat_map(slots::mentioned).collect();
    names.into_iter().filter_map(|slot| Some((slot.to_owned(), slots::module_of(slot, what.slots.get(slot)?)))).collect()
}

struct Reader<'a> {
    library: &'a Library,
    what: &'a Specialisation,
    module: &'a naga::Module,
    layouter: Layouter,
    comments: BTreeMap<&'a str, Comments>,
}

impl Reader<'_> {
    /// Module path and declared name of a linked name.
    fn origin(&self, name: &str) -> (String, String) {
        unmangle(name).unwrap_or_else(|| (self.what.entry.clone(), name.to_owned()))
    }

    fn doc(&self, module: &str, name: &str) -> crate::comments::Doc {
        self.comments.get(module).map(|comments| comments.of(name)).unwrap_or_default()
    }

    fn bindings(&self, info: &naga::valid::ModuleInfo) -> Result<(Vec<Binding>, Vec<Handle<naga::GlobalVariable>>), ShaderError> {
        let mut found = Vec::new();
        for (handle, variable) in self.module.global_variables.iter() {
            let Some(place) = &variable.binding else { continue };
            let used = (0..self.module.entry_points.len()).fold(GlobalUse::empty(), |all, i| all | info.get_entry_point(i)[handle]);
            if used.is_empty() {
                continue;
            }
            let (module, name) = self.origin(variable.name.as_deref().unwrap_or_default());
            let doc = self.doc(&module, &name);
            let unbindable = |why| locate::declaration(self.library, &module, &name, format!("binding `{name}`: {why}"));
            let resource = self.resource(variable).map_err(unbindable)?;
            let binding = Binding {
                group: place.group,
                binding: place.binding,
                name,
                module,
                resource,
                read: used.contains(GlobalUse::READ),
                written: used.contains(GlobalUse::WRITE),
                doc: doc.text,
                tags: doc.tags,
            };
            found.push((binding, handle));
        }
        found.sort_by_key(|(binding, _)| (binding.group, binding.binding));
        Ok(found.into_iter().unzip())
    }

    fn resource(&self, variable: &naga::GlobalVariable) -> Result<ResourceKind, String> {
        let ty = &self.module.types[variable.ty];
        match variable.space {
            AddressSpace::Uniform => Ok(ResourceKind::Uniform { ty: self.layout(variable.ty) }),
            AddressSpace::Storage { access } => {
                let writable = access.contains(StorageAccess::STORE);
                Ok(match ty.inner {
                    TypeInner::Array { base, size: naga::ArraySize::Dynamic, stride } => {
                        ResourceKind::StorageArray { ty: self.layout(base), stride, writable }
                    }
                    _ => ResourceKind::Storage { ty: self.layout(variable.ty), writable },
                })
            }
            AddressSpace::Handle => match ty.inner {
                TypeInner::Sampler { .. } => Ok(ResourceKind::Sampler),
                TypeInner::Image { class: naga::ImageClass::Sampled { .. }, .. } => {
                    Ok(ResourceKind::Texture { ty: self.layout(variable.ty).name })
                }
                _ => Err("only sampled textures and samplers can be bound; write to storage buffers instead".into()),
            },
            space => Err(format!("address space {space:?} cannot be bound")),
        }
    }

    fn layout(&self, ty: Handle<naga::Type>) -> Layout {
        let size = self.layouter[ty].size;
        let align = self.layouter[ty].alignment.round_up(1);
        let inner = &self.module.types[ty];
        match &inner.inner {
            TypeInner::Struct { members, span } => self.structure(inner.name.as_deref().unwrap_or_default(), members, *span, align),
            TypeInner::Array { base, size: count, .. } => {
                let element = self.layout(*base);
                let count = match count {
                    naga::ArraySize::Constant(n) => n.to_string(),
                    _ => String::new(),
                };
                // Members of the element would be taken for the array's own; its canonical name says all that matters.
                let name = if element.members.is_empty() { element.name } else { element.canonical() };
                Layout { name: format!("array<{name}, {count}>"), size, align, members: Vec::new() }
            }
            _ => Layout { name: self.module.types.type_to_string(ty), size, align, members: Vec::new() },
        }
    }

    fn structure(&self, linked: &str, members: &[naga::StructMember], size: u32, align: u32) -> Layout {
        let (module, name) = self.origin(linked);
        let members: Vec<Member> = members
            .iter()
            .map(|member| {
                let member_name = member.name.clone().unwrap_or_default();
                let doc = self.doc(&module, &format!("{name}.{member_name}"));
                Member { name: member_name, offset: member.offset, ty: self.layout(member.ty), doc: doc.text, tags: doc.tags }
            })
            .collect();
        Layout { name: self.people_name(&module, name, &members), size, align, members }
    }

    /// `Reservoir<di>` for a struct that holds a type of a slot's module; `Sample` of `domain/di` itself is `Sample<di>`.
    fn people_name(&self, module: &str, name: String, members: &[Member]) -> String {
        let own = self.what.slots.iter().find(|(slot, filling)| slots::module_of(slot, filling) == *module);
        let held = || {
            members.iter().find_map(|member| {
                Some(member.ty.name.split_once('<')?.1.strip_suffix('>')?.to_owned()).filter(|_| !member.ty.members.is_empty())
            })
        };
        match own.map(|(_, filling)| filling.clone()).or_else(held) {
            Some(filling) => format!("{name}<{filling}>"),
            None => name,
        }
    }

    fn entries(&self, info: &naga::valid::ModuleInfo, handles: &[Handle<naga::GlobalVariable>]) -> Vec<Entry> {
        let points = self.module.entry_points.iter().enumerate();
        points
            .filter_map(|(i, point)| {
                let stage = match point.stage {
                    naga::ShaderStage::Compute => Stage::Compute,
                    naga::ShaderStage::Vertex => Stage::Vertex,
                    naga::ShaderStage::Fragment => Stage::Fragment,
                    _ => return None,
                };
                let reached = handles.iter().enumerate().filter(|(_, handle)| !info.get_entry_point(i)[**handle].is_empty());
                let bindings = reached.map(|(at, _)| at).collect();
                let outputs = if stage == Stage::Fragment { self.outputs(point) } else { Vec::new() };
                Some(Entry { name: point.name.clone(), stage, workgroup_size: point.workgroup_size, bindings, outputs })
            })
            .collect()
    }

    fn outputs(&self, point: &naga::EntryPoint) -> Vec<Output> {
        let Some(result) = &point.function.result else { return Vec::new() };
        let TypeInner::Struct { members, .. } = &self.module.types[result.ty].inner else { return Vec::new() };
        let output = |member: &naga::StructMember| match member.binding {
            Some(naga::Binding::Location { location, .. }) => {
                let name = member.name.clone().unwrap_or_default();
                Some(Output { name, location, ty: self.module.types.type_to_string(member.ty) })
            }
            _ => None,
        };
        members.iter().filter_map(output).collect()
    }

    fn overrides(&self) -> Result<Vec<Override>, ShaderError> {
        let mut found: Vec<Override> = Vec::new();
        for (_, constant) in self.module.overrides.iter() {
            let Some(key) = constant.name.clone() else { continue };
            let (module, name) = self.origin(&key);
            let Some(ty) = self.scalar(constant.ty) else { continue };
            if let Some(other) = found.iter().find(|other| other.name == name) {
                return Err(ShaderError::OverrideTwice { name, first: other.module.clone(), second: module });
            }
            let doc = self.doc(&module, &name);
            let default = constant.init.and_then(|init| self.literal(init));
            found.push(Override { name, key, module, ty, default, doc: doc.text, tags: doc.tags });
        }
        Ok(found)
    }

    fn scalar(&self, ty: Handle<naga::Type>) -> Option<Scalar> {
        match self.module.types[ty].inner {
            TypeInner::Scalar(scalar) => match scalar.kind {
                ScalarKind::Bool => Some(Scalar::Bool),
                ScalarKind::Sint => Some(Scalar::I32),
                ScalarKind::Uint => Some(Scalar::U32),
                ScalarKind::Float => Some(Scalar::F32),
                _ => None,
            },
            _ => None,
        }
    }

    fn literal(&self, init: Handle<naga::Expression>) -> Option<f64> {
        match self.module.global_expressions[init] {
            naga::Expression::Literal(naga::Literal::F32(value)) => Some(f64::from(value)),
            naga::Expression::Literal(naga::Literal::U32(value)) => Some(f64::from(value)),
            naga::Expression::Literal(naga::Literal::I32(value)) => Some(f64::from(value)),
            naga::Expression::Literal(naga::Literal::Bool(value)) => Some(f64::from(u8::from(value))),
            _ => None,
        }
    }

    fn bias(&self) -> Vec<BiasNote> {
        let lines = self.comments.iter().flat_map(|(path, comments)| comments.bias.iter().map(move |line| (path, line)));
        let of_slots = lines.filter(|(_, line)| self.slot_holds(line.condition.as_deref()));
        let note = |(path, line): (&&str, &BiasLine)| {
            let given = line.condition.clone().filter(|condition| !condition.contains('='));
            BiasNote { module: (*path).to_owned(), why: line.why.clone(), given, without: line.without.clone() }
        };
        of_slots.map(note).collect()
    }

    /// False for `slot = filling` where the slot is filled otherwise.
    fn slot_holds(&self, condition: Option<&str>) -> bool {
        let Some((slot, filling)) = condition.and_then(|condition| condition.split_once('=')) else { return true };
        self.what.slots.get(slot.trim()).is_some_and(|found| found == filling.trim())
    }
}
