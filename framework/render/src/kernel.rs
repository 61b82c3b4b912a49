//! One compute entry point, ready to run, its bindings found by name.

use crate::{
    Context, Error,
    layout::GROUPS,
    program::{Program, Recipe, find, qualified},
};
use aquifer_shader::{Binding, Composed, Stage};

/// One compute entry point with its pipeline. Kernels of equal text, entry point and constants share the pipeline.
#[derive(Clone, Debug)]
pub struct Kernel {
    entry: String,
    workgroup_size: [u32; 3],
    program: Program<wgpu::ComputePipeline>,
}

impl Kernel {
    /// Compiles `entry` of a composed shader, with `override`s set by name; `label` names it in errors.
    ///
    /// # Errors
    /// [`Error::NoEntry`], [`Error::NoName`] for a constant that the shader does not declare, and what [`Context::guard`] finds.
    pub fn compute(context: &Context, label: &str, composed: &Composed, entry: &str, constants: &[(&str, f64)]) -> Result<Kernel, Error> {
        let found = find(label, composed, Stage::Compute, entry)?;
        let entries = [found];
        let recipe = Recipe::new(context, label, composed, &entries, constants)?;
        let program = recipe.program(&context.pipelines().compute, |with| {
            with.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: with.label,
                layout: Some(with.layout),
                module: with.module,
                entry_point: Some(entry),
                compilation_options: with.options,
                cache: None,
            })
        })?;
        Ok(Kernel { entry: entry.to_owned(), workgroup_size: found.workgroup_size, program })
    }

    /// The entry point's name.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// Invocations of one workgroup.
    pub fn workgroup_size(&self) -> [u32; 3] {
        self.workgroup_size
    }

    /// What the entry point reaches.
    pub fn bindings(&self) -> &[Binding] {
        self.program.bindings()
    }

    /// A bind group of one group, every resource found by its declaration; `None` when the entry point reaches nothing of it.
    ///
    /// # Errors
    /// [`Error::Unbound`] when `find` gives nothing, and what [`Context::guard`] finds.
    pub fn bind<'a>(
        &self,
        context: &Context,
        group: u32,
        find: impl FnMut(&Binding) -> Option<wgpu::BindingResource<'a>>,
    ) -> Result<Option<wgpu::BindGroup>, Error> {
        self.program.bind(context, group, find)
    }

    /// Sets pipeline and bind groups, by group, and dispatches.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>, groups: &[Option<&wgpu::BindGroup>], workgroups: [u32; 3]) {
        pass.set_pipeline(self.program.pipeline());
        for (index, group) in (0..).zip(groups) {
            if let Some(group) = group {
                pass.set_bind_group(index, *group, &[]);
            }
        }
        let [x, y, z] = workgroups;
        pass.dispatch_workgroups(x, y, z);
    }

    /// The bind groups of all groups, by group; see [`Kernel::bind`].
    ///
    /// # Errors
    /// As [`Kernel::bind`].
    pub fn bind_all<'a>(
        &self,
        context: &Context,
        find: impl Fn(&Binding) -> Option<wgpu::BindingResource<'a>>,
    ) -> Result<Vec<Option<wgpu::BindGroup>>, Error> {
        (0..GROUPS).map(|group| self.bind(context, group, &find)).collect()
    }

    /// The binding of that declared or qualified name.
    ///
    /// # Errors
    /// [`Error::NoName`].
    pub fn binding(&self, name: &str) -> Result<&Binding, Error> {
        self.bindings().iter().find(|binding| names(binding, name)).ok_or_else(|| Error::NoName {
            shader: format!("{}::{}", self.program.label(), self.entry),
            name: name.to_owned(),
            known: self.bindings().iter().map(qualified).collect(),
        })
    }
}

/// The binding has that declared or qualified name.
pub(crate) fn names(binding: &Binding, name: &str) -> bool {
    match name.split_once("::") {
        Some((module, name)) => binding.module == module && binding.name == name,
        None => binding.name == name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_shader::{Library, Specialisation};

    #[test]
    fn kernels_of_equal_specialisation_share_their_pipeline() {
        let context = Context::noop(wgpu::Limits::default()).unwrap();
        let mut library = Library::new();
        let text = "override n: u32 = 1u;\n@group(1) @binding(0) var<storage, read_write> x: u32;\n\
                    @compute @workgroup_size(1) fn one() { x = n; }\n@compute @workgroup_size(1) fn two() { x = n + 1u; }\n";
        library.insert("k", text, "k.wgsl");
        let shader = library.compose(&Specialisation { entry: "k".to_owned(), ..Default::default() }).unwrap();
        let kernel = |label: &str, entry: &str, n| Kernel::compute(&context, label, &shader, entry, &[("n", n)]).unwrap();
        let first = kernel("a", "one", 1.0);
        assert!(first.program.shares(&kernel("b", "one", 1.0).program));
        assert!(!first.program.shares(&kernel("a", "one", 2.0).program));
        assert!(!first.program.shares(&kernel("a", "two", 1.0).program));
    }
}
