//! One compute entry point, ready to run, its bindings found by name.

use crate::{
    Context, Error,
    cache::Pipeline,
    layout::{self, GROUPS},
};
use aquifer_shader::{Binding, Composed, Entry, Stage};
use std::{borrow::Cow, sync::Arc};

/// One compute entry point with its pipeline. Kernels of equal text, entry point and constants share the pipeline.
#[derive(Clone, Debug)]
pub struct Kernel {
    label: String,
    entry: String,
    workgroup_size: [u32; 3],
    bindings: Vec<Binding>,
    pipeline: Arc<Pipeline>,
}

impl Kernel {
    /// Compiles `entry` of a composed shader, with `override`s set by name; `label` names it in errors.
    ///
    /// # Errors
    /// [`Error::NoEntry`], [`Error::NoName`] for a constant that the shader does not declare, and what [`Context::guard`] finds.
    pub fn compute(context: &Context, label: &str, composed: &Composed, entry: &str, constants: &[(&str, f64)]) -> Result<Kernel, Error> {
        let found = find(label, composed, entry)?;
        let constants = keyed(label, composed, constants)?;
        let bindings: Vec<Binding> = found.bindings.iter().map(|&index| composed.interface.bindings[index].clone()).collect();
        let recipe = Recipe { context, label, composed, entry, constants: &constants, bindings: &bindings };
        let pipeline = context.pipelines().pipeline(&composed.text, entry, &constants, || recipe.compile())?;
        Ok(Kernel { label: label.to_owned(), entry: entry.to_owned(), workgroup_size: found.workgroup_size, bindings, pipeline })
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
        &self.bindings
    }

    /// A bind group of one group, every resource found by its declaration; `None` when the entry point reaches nothing of it.
    ///
    /// # Errors
    /// [`Error::Unbound`] when `find` gives nothing, and what [`Context::guard`] finds.
    pub fn bind<'a>(
        &self,
        context: &Context,
        group: u32,
        mut find: impl FnMut(&Binding) -> Option<wgpu::BindingResource<'a>>,
    ) -> Result<Option<wgpu::BindGroup>, Error> {
        let Some(layout) = &self.pipeline.layouts[group as usize] else { return Ok(None) };
        let of_group = self.bindings.iter().filter(|binding| binding.group == group);
        let entries: Result<Vec<_>, Error> = of_group
            .map(|binding| {
                let resource = find(binding).ok_or_else(|| Error::Unbound { pass: self.label.clone(), binding: qualified(binding) })?;
                Ok(wgpu::BindGroupEntry { binding: binding.binding, resource })
            })
            .collect();
        let entries = entries?;
        let descriptor = wgpu::BindGroupDescriptor { label: Some(&self.label), layout, entries: &entries };
        context.guard(&self.label, || context.device().create_bind_group(&descriptor)).map(Some)
    }

    /// Sets pipeline and bind groups, by group, and dispatches.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>, groups: &[Option<&wgpu::BindGroup>], workgroups: [u32; 3]) {
        pass.set_pipeline(&self.pipeline.pipeline);
        for (index, group) in (0..).zip(groups) {
            if let Some(group) = group {
                pass.set_bind_group(index, *group, &[]);
            }
        }
        let [x, y, z] = workgroups;
        pass.dispatch_workgroups(x, y, z);
    }

    /// Records one dispatch on the caller's own buffers, given by declared or qualified name (`count`, `base/rng::count`).
    ///
    /// # Errors
    /// [`Error::NoName`] for a name that the entry point does not reach, [`Error::Unbound`], and what [`Context::guard`] finds.
    pub fn record(
        &self,
        context: &Context,
        encoder: &mut wgpu::CommandEncoder,
        buffers: &[(&str, &wgpu::Buffer)],
        workgroups: [u32; 3],
    ) -> Result<(), Error> {
        for (name, _) in buffers {
            self.binding(name)?;
        }
        let find = |binding: &Binding| {
            let (_, buffer) = buffers.iter().find(|(name, _)| names(binding, name))?;
            Some(buffer.as_entire_binding())
        };
        let groups: Result<Vec<_>, Error> = (0..GROUPS).map(|group| self.bind(context, group, find)).collect();
        let groups = groups?;
        let groups: Vec<_> = groups.iter().map(Option::as_ref).collect();
        context.guard(&self.label, || {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(&self.label), timestamp_writes: None });
            self.dispatch(&mut pass, &groups, workgroups);
        })
    }

    /// The binding of that declared or qualified name.
    ///
    /// # Errors
    /// [`Error::NoName`].
    pub fn binding(&self, name: &str) -> Result<&Binding, Error> {
        self.bindings.iter().find(|binding| names(binding, name)).ok_or_else(|| Error::NoName {
            shader: format!("{}::{}", self.label, self.entry),
            name: name.to_owned(),
            known: self.bindings.iter().map(qualified).collect(),
        })
    }
}

fn names(binding: &Binding, name: &str) -> bool {
    match name.split_once("::") {
        Some((module, name)) => binding.module == module && binding.name == name,
        None => binding.name == name,
    }
}

/// `module::name`.
pub(crate) fn qualified(binding: &Binding) -> String {
    format!("{}::{}", binding.module, binding.name)
}

fn find<'a>(label: &str, composed: &'a Composed, entry: &str) -> Result<&'a Entry, Error> {
    let compute = || composed.interface.entries.iter().filter(|entry| entry.stage == Stage::Compute);
    compute().find(|candidate| candidate.name == entry).ok_or_else(|| Error::NoEntry {
        shader: label.to_owned(),
        entry: entry.to_owned(),
        known: compute().map(|entry| entry.name.clone()).collect(),
    })
}

/// Constants under the keys that a pipeline takes.
fn keyed(label: &str, composed: &Composed, constants: &[(&str, f64)]) -> Result<Vec<(String, f64)>, Error> {
    let overrides = &composed.interface.overrides;
    let key = |&(name, value): &(&str, f64)| match overrides.iter().find(|known| known.name == name) {
        Some(known) => Ok((known.key.clone(), value)),
        None => Err(Error::NoName {
            shader: label.to_owned(),
            name: name.to_owned(),
            known: overrides.iter().map(|known| known.name.clone()).collect(),
        }),
    };
    constants.iter().map(key).collect()
}

/// All that a pipeline is made from.
struct Recipe<'a> {
    context: &'a Context,
    label: &'a str,
    composed: &'a Composed,
    entry: &'a str,
    constants: &'a [(String, f64)],
    bindings: &'a [Binding],
}

impl Recipe<'_> {
    fn compile(&self) -> Result<Pipeline, Error> {
        let module = self.module()?;
        self.context.guard(self.label, || {
            let layouts: Vec<_> = (0..GROUPS).map(|group| self.layout(group)).collect();
            Pipeline { pipeline: self.pipeline(&module, &layouts), layouts }
        })
    }

    fn module(&self) -> Result<wgpu::ShaderModule, Error> {
        let device = self.context.device();
        let make = || {
            let source = wgpu::ShaderSource::Naga(Cow::Owned(self.composed.module.clone()));
            let descriptor = wgpu::ShaderModuleDescriptor { label: Some(self.label), source };
            self.context.guard(self.label, || device.create_shader_module(descriptor))
        };
        self.context.pipelines().module(&self.composed.text, make)
    }

    fn layout(&self, group: u32) -> Option<wgpu::BindGroupLayout> {
        let entries = layout::entries(self.composed, self.bindings, group);
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(self.label), entries: &entries };
        (!entries.is_empty()).then(|| self.context.device().create_bind_group_layout(&descriptor))
    }

    fn pipeline(&self, module: &wgpu::ShaderModule, layouts: &[Option<wgpu::BindGroupLayout>]) -> wgpu::ComputePipeline {
        let device = self.context.device();
        let layouts: Vec<_> = layouts.iter().map(Option::as_ref).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        let constants: Vec<(&str, f64)> = self.constants.iter().map(|(key, value)| (key.as_str(), *value)).collect();
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            module,
            entry_point: Some(self.entry),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache: None,
        })
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
        assert!(Arc::ptr_eq(&first.pipeline, &kernel("b", "one", 1.0).pipeline));
        assert!(!Arc::ptr_eq(&first.pipeline, &kernel("a", "one", 2.0).pipeline));
        assert!(!Arc::ptr_eq(&first.pipeline, &kernel("a", "two", 1.0).pipeline));
    }
}
