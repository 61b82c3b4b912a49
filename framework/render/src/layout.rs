//! Bind group layouts from reflection: no binding number is written by hand.

use aquifer_shader::{Binding, Composed, Entry, ResourceKind, Stage};
use std::num::NonZeroU64;

/// Groups that a shader may use: 0 is the frame's and the scene's, 1 the pass's own.
pub(crate) const GROUPS: u32 = 2;

/// A binding with the stages that reach it.
pub(crate) struct Reached<'a> {
    pub binding: &'a Binding,
    stages: wgpu::ShaderStages,
}

/// What the entry points of one pipeline reach, in the order of reflection.
pub(crate) fn reached<'a>(composed: &'a Composed, entries: &[&Entry]) -> Vec<Reached<'a>> {
    let stages = |index: usize| {
        let reaching = entries.iter().filter(|entry| entry.bindings.contains(&index));
        reaching.fold(wgpu::ShaderStages::NONE, |stages, entry| stages | stage(entry.stage))
    };
    let all = composed.interface.bindings.iter().enumerate().map(|(index, binding)| Reached { binding, stages: stages(index) });
    all.filter(|reached| !reached.stages.is_empty()).collect()
}

fn stage(stage: Stage) -> wgpu::ShaderStages {
    match stage {
        Stage::Compute => wgpu::ShaderStages::COMPUTE,
        Stage::Vertex => wgpu::ShaderStages::VERTEX,
        Stage::Fragment => wgpu::ShaderStages::FRAGMENT,
    }
}

/// The layout of one group.
pub(crate) fn entries(composed: &Composed, reached: &[Reached<'_>], group: u32) -> Vec<wgpu::BindGroupLayoutEntry> {
    // A texture can be declared filterable only when its format is; sampling needs a sampler, loading does not.
    let sampled = reached.iter().any(|reached| reached.binding.resource == ResourceKind::Sampler);
    let of_group = reached.iter().filter(|reached| reached.binding.group == group);
    let entry = |reached: &Reached<'_>| {
        Some(wgpu::BindGroupLayoutEntry {
            binding: reached.binding.binding,
            visibility: reached.stages,
            ty: ty(composed, reached.binding, sampled)?,
            count: None,
        })
    };
    // What has no type here is left out, and refused by name when the pipeline is made.
    of_group.filter_map(entry).collect()
}

fn ty(composed: &Composed, binding: &Binding, sampled: bool) -> Option<wgpu::BindingType> {
    let buffer =
        |ty, least: u32| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: NonZeroU64::new(least.into()) };
    let storage = |writable: bool| wgpu::BufferBindingType::Storage { read_only: !writable };
    Some(match &binding.resource {
        ResourceKind::Uniform { ty } => buffer(wgpu::BufferBindingType::Uniform, ty.size),
        ResourceKind::StorageArray { stride, writable, .. } => buffer(storage(*writable), *stride),
        ResourceKind::Storage { ty, writable } => buffer(storage(*writable), ty.size),
        ResourceKind::Texture { .. } => texture(&composed.module, binding, sampled)?,
        ResourceKind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
    })
}

fn texture(module: &naga::Module, binding: &Binding, sampled: bool) -> Option<wgpu::BindingType> {
    let place = naga::ResourceBinding { group: binding.group, binding: binding.binding };
    let (_, variable) = module.global_variables.iter().find(|(_, variable)| variable.binding == Some(place))?;
    let naga::TypeInner::Image { dim, arrayed, class: naga::ImageClass::Sampled { kind, multi } } = module.types[variable.ty].inner else {
        return None;
    };
    Some(wgpu::BindingType::Texture {
        sample_type: match kind {
            naga::ScalarKind::Sint => wgpu::TextureSampleType::Sint,
            naga::ScalarKind::Uint => wgpu::TextureSampleType::Uint,
            _ => wgpu::TextureSampleType::Float { filterable: sampled },
        },
        view_dimension: view(dim, arrayed),
        multisampled: multi,
    })
}

fn view(dim: naga::ImageDimension, arrayed: bool) -> wgpu::TextureViewDimension {
    use naga::ImageDimension as Image;
    match (dim, arrayed) {
        (Image::D1, _) => wgpu::TextureViewDimension::D1,
        (Image::D2, false) => wgpu::TextureViewDimension::D2,
        (Image::D2, true) => wgpu::TextureViewDimension::D2Array,
        (Image::D3, _) => wgpu::TextureViewDimension::D3,
        (Image::Cube, false) => wgpu::TextureViewDimension::Cube,
        (Image::Cube, true) => wgpu::TextureViewDimension::CubeArray,
    }
}
