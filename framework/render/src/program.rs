//! What kernels and drawings have in common: a pipeline whose bindings are found by name.

use crate::{
    Context, Error,
    cache::{Kept, Pipeline, key},
    layout::{self, GROUPS, Reached},
};
use aquifer_shader::{Binding, Composed, Entry, Stage};
use std::{borrow::Cow, sync::Arc};

/// A pipeline with what its entry points reach.
#[derive(Debug)]
pub(crate) struct Program<P> {
    label: String,
    bindings: Vec<Binding>,
    pipeline: Arc<Pipeline<P>>,
}

impl<P> Clone for Program<P> {
    fn clone(&self) -> Self {
        Program { label: self.label.clone(), bindings: self.bindings.clone(), pipeline: self.pipeline.clone() }
    }
}

impl<P> Program<P> {
    pub fn label(&self) -> &str {
        &self.label
    }

    pub fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    pub fn pipeline(&self) -> &P {
        &self.pipeline.pipeline
    }

    /// Is it the same pipeline, not only an equal one?
    #[cfg(test)]
    pub fn shares(&self, other: &Program<P>) -> bool {
        Arc::ptr_eq(&self.pipeline, &other.pipeline)
    }

    /// A bind group of one group, every resource found by its declaration; `None` when nothing of it is reached.
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
}

/// `module::name`.
pub(crate) fn qualified(binding: &Binding) -> String {
    format!("{}::{}", binding.module, binding.name)
}

/// The entry point of that stage and name.
pub(crate) fn find<'a>(label: &str, composed: &'a Composed, stage: Stage, entry: &str) -> Result<&'a Entry, Error> {
    let of_stage = || composed.interface.entries.iter().filter(|entry| entry.stage == stage);
    of_stage().find(|candidate| candidate.name == entry).ok_or_else(|| Error::NoEntry {
        shader: label.to_owned(),
        stage: name(stage),
        entry: entry.to_owned(),
        known: of_stage().map(|entry| entry.name.clone()).collect(),
    })
}

/// As messages call it.
pub(crate) fn name(stage: Stage) -> &'static str {
    match stage {
        Stage::Compute => "compute",
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
    }
}

/// All that a pipeline is made from.
pub(crate) struct Recipe<'a> {
    context: &'a Context,
    label: &'a str,
    composed: &'a Composed,
    entries: &'a [&'a Entry],
    constants: Vec<(String, f64)>,
    reached: Vec<Reached<'a>>,
}

/// What every kind of pipeline is made with.
pub(crate) struct Ingredients<'a> {
    pub device: &'a wgpu::Device,
    pub label: wgpu::Label<'a>,
    pub module: &'a wgpu::ShaderModule,
    pub layout: &'a wgpu::PipelineLayout,
    pub options: wgpu::PipelineCompilationOptions<'a>,
}

impl<'a> Recipe<'a> {
    /// Of the entry points of one pipeline, with `override`s set by name.
    pub fn new(
        context: &'a Context,
        label: &'a str,
        composed: &'a Composed,
        entries: &'a [&'a Entry],
        constants: &[(&str, f64)],
    ) -> Result<Self, Error> {
        let constants = keyed(label, composed, constants)?;
        Ok(Recipe { context, label, composed, entries, constants, reached: layout::reached(composed, entries) })
    }

    /// The pipeline from those that are kept, or made by `make`.
    pub fn program<P>(&self, kept: &Kept<P>, make: impl FnOnce(Ingredients<'_>) -> P) -> Result<Program<P>, Error> {
        let entries: Vec<&str> = self.entries.iter().map(|entry| entry.name.as_str()).collect();
        let key = key(&self.composed.text, &entries, &self.constants);
        let pipeline = kept.pipeline(key, || self.compile(make))?;
        let bindings = self.reached.iter().map(|reached| reached.binding.clone()).collect();
        Ok(Program { label: self.label.to_owned(), bindings, pipeline })
    }

    fn compile<P>(&self, make: impl FnOnce(Ingredients<'_>) -> P) -> Result<Pipeline<P>, Error> {
        let module = self.module()?;
        let (device, label) = (self.context.device(), Some(self.label));
        let constants: Vec<(&str, f64)> = self.constants.iter().map(|(key, value)| (key.as_str(), *value)).collect();
        self.context.guard(self.label, || {
            let layouts: Vec<_> = (0..GROUPS).map(|group| self.layout(group)).collect();
            let bind_group_layouts: Vec<_> = layouts.iter().map(Option::as_ref).collect();
            let descriptor = wgpu::PipelineLayoutDescriptor { label, bind_group_layouts: &bind_group_layouts, immediate_size: 0 };
            let layout = device.create_pipeline_layout(&descriptor);
            let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
            let pipeline = make(Ingredients { device, label, module: &module, layout: &layout, options });
            Pipeline { pipeline, layouts }
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
        let entries = layout::entries(self.composed, &self.reached, group);
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(self.label), entries: &entries };
        (!entries.is_empty()).then(|| self.context.device().create_bind_group_layout(&descriptor))
    }
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
