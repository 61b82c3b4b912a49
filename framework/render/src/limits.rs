//! What an adapter offers, and whether a plan fits into it: said before anything is allocated.

use crate::{Error, workgroup_memory};
use aquifer_graph::{Extent, Plan, Step};
use aquifer_shader::{Composed, Entry, Interface, ResourceKind, Stage};
use std::collections::BTreeMap;

/// wgpu resolves the queries of one set at a time, two a pass.
const MAX_STEPS: u64 = wgpu::QUERY_SET_MAX_QUERIES as u64 / 2;

type Getter = fn(&wgpu::Limits) -> u64;

/// The limits that a graph can run into, by wgpu's names.
const NAMED: [(&str, Getter); 12] = [
    ("max_storage_buffers_per_shader_stage", |l| l.max_storage_buffers_per_shader_stage.into()),
    ("max_uniform_buffers_per_shader_stage", |l| l.max_uniform_buffers_per_shader_stage.into()),
    ("max_sampled_textures_per_shader_stage", |l| l.max_sampled_textures_per_shader_stage.into()),
    ("max_samplers_per_shader_stage", |l| l.max_samplers_per_shader_stage.into()),
    ("max_storage_buffer_binding_size", |l| l.max_storage_buffer_binding_size),
    ("max_buffer_size", |l| l.max_buffer_size),
    ("max_texture_dimension_2d", |l| l.max_texture_dimension_2d.into()),
    ("max_texture_array_layers", |l| l.max_texture_array_layers.into()),
    ("max_compute_workgroup_storage_size", |l| l.max_compute_workgroup_storage_size.into()),
    ("max_compute_invocations_per_workgroup", |l| l.max_compute_invocations_per_workgroup.into()),
    ("max_compute_workgroup_size_x", |l| l.max_compute_workgroup_size_x.into()),
    ("max_compute_workgroups_per_dimension", |l| l.max_compute_workgroups_per_dimension.into()),
];

/// The named limits with their values.
pub(crate) fn named(limits: &wgpu::Limits) -> BTreeMap<&'static str, u64> {
    NAMED.iter().map(|(name, get)| (*name, get(limits))).collect()
}

/// WebGPU's defaults, with what a graph can run into raised to what is offered.
pub(crate) fn raised_to(offered: &wgpu::Limits) -> wgpu::Limits {
    wgpu::Limits {
        max_storage_buffers_per_shader_stage: offered.max_storage_buffers_per_shader_stage,
        max_uniform_buffers_per_shader_stage: offered.max_uniform_buffers_per_shader_stage,
        max_buffers_and_acceleration_structures_per_shader_stage: offered.max_buffers_and_acceleration_structures_per_shader_stage,
        max_sampled_textures_per_shader_stage: offered.max_sampled_textures_per_shader_stage,
        max_samplers_per_shader_stage: offered.max_samplers_per_shader_stage,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        max_uniform_buffer_binding_size: offered.max_uniform_buffer_binding_size,
        max_buffer_size: offered.max_buffer_size,
        max_texture_dimension_2d: offered.max_texture_dimension_2d,
        max_texture_array_layers: offered.max_texture_array_layers,
        max_compute_workgroup_storage_size: offered.max_compute_workgroup_storage_size,
        max_compute_invocations_per_workgroup: offered.max_compute_invocations_per_workgroup,
        max_compute_workgroup_size_x: offered.max_compute_workgroup_size_x,
        max_compute_workgroup_size_y: offered.max_compute_workgroup_size_y,
        max_compute_workgroup_size_z: offered.max_compute_workgroup_size_z,
        max_compute_workgroups_per_dimension: offered.max_compute_workgroups_per_dimension,
        ..wgpu::Limits::default().or_worse_values_from(offered)
    }
}

/// One thing that is limited.
#[derive(Clone, Copy, Debug)]
pub struct Need {
    /// wgpu's name of the limit.
    pub limit: &'static str,
    /// What is counted, in the plural.
    pub unit: &'static str,
    /// What to do when there are not enough: from `; `, or empty.
    pub cure: &'static str,
}

impl Need {
    /// An error that names `what` when more is needed than offered.
    ///
    /// # Errors
    /// [`Error::LimitTooSmall`].
    pub fn require(self, what: &str, needed: u64, offered: u64) -> Result<(), Error> {
        let Need { limit, unit, cure } = self;
        if needed <= offered {
            return Ok(());
        }
        Err(Error::LimitTooSmall { what: what.to_owned(), limit, unit, needed, offered, cure })
    }
}

/// Rows of a texture.
pub(crate) const TABLE_ROWS: Need =
    Need { limit: "max_texture_dimension_2d", unit: "rows of 8192 texels of 16 bytes", cure: "; a scene with fewer triangles fits" };

/// One binding of a storage buffer, in bytes.
pub const BINDING_SIZE: Need = Need { limit: "max_storage_buffer_binding_size", unit: "bytes", cure: "; a smaller --size needs less" };
/// One buffer, in bytes.
pub const BUFFER_SIZE: Need = Need { limit: "max_buffer_size", unit: "bytes", cure: "; a smaller --size needs less" };

/// Whether `plan`, whose steps have the given shaders, fits a device of these limits.
///
/// # Errors
/// [`Error::LimitTooSmall`] names the step or resource; [`Error::EmptyImage`].
pub fn check<'a>(plan: &Plan, shaders: impl IntoIterator<Item = &'a Composed>, size: [u32; 2], limits: &wgpu::Limits) -> Result<(), Error> {
    let [width, height] = size;
    if width == 0 || height == 0 {
        return Err(Error::EmptyImage { width, height });
    }
    let steps = Need { limit: "QUERY_SET_MAX_QUERIES / 2", unit: "passes", cure: "" };
    steps.require("the graph", plan.steps.len() as u64, MAX_STEPS)?;
    for resource in &plan.resources {
        fits(&format!("resource `{}`", resource.name), resource.bytes(size), limits)?;
    }
    for (step, shader) in plan.steps.iter().zip(shaders) {
        unwired_fit(step, size, limits)?;
        entries_fit(&step.node, &shader.interface, limits)?;
        workgroup_memory::check(&step.node, shader, limits)?;
        dispatches_fit(step, &shader.interface, size, limits)?;
    }
    Ok(())
}

fn fits(what: &str, bytes: u64, limits: &wgpu::Limits) -> Result<(), Error> {
    BINDING_SIZE.require(what, bytes, limits.max_storage_buffer_binding_size)?;
    BUFFER_SIZE.require(what, bytes, limits.max_buffer_size)
}

fn unwired_fit(step: &Step, size: [u32; 2], limits: &wgpu::Limits) -> Result<(), Error> {
    for port in step.contract.ports.iter().filter(|port| step.resource(&port.name).is_none()) {
        fits(&format!("unwired port `{}.{}`", step.node, port.name), crate::pool::bytes(&port.ty, size), limits)?;
    }
    Ok(())
}

fn entries_fit(node: &str, interface: &Interface, limits: &wgpu::Limits) -> Result<(), Error> {
    for entry in &interface.entries {
        let what = format!("entry point `{}` of pass `{node}`", entry.name);
        bindings_fit(&what, entry, interface, limits)?;
        if entry.stage == Stage::Compute {
            workgroup_fits(&what, entry.workgroup_size, limits)?;
        }
    }
    Ok(())
}

fn bindings_fit(what: &str, entry: &Entry, interface: &Interface, limits: &wgpu::Limits) -> Result<(), Error> {
    let count = |wanted: fn(&ResourceKind) -> bool| {
        entry.bindings.iter().filter(|&&index| wanted(&interface.bindings[index].resource)).count() as u64
    };
    let storage = count(|kind| matches!(kind, ResourceKind::Storage { .. } | ResourceKind::StorageArray { .. }));
    let need = |limit, unit| Need { limit, unit, cure: "" };
    need("max_storage_buffers_per_shader_stage", "storage buffers").require(
        what,
        storage,
        limits.max_storage_buffers_per_shader_stage.into(),
    )?;
    need("max_uniform_buffers_per_shader_stage", "uniform buffers").require(
        what,
        count(|kind| matches!(kind, ResourceKind::Uniform { .. })),
        limits.max_uniform_buffers_per_shader_stage.into(),
    )?;
    need("max_sampled_textures_per_shader_stage", "textures").require(
        what,
        count(|kind| matches!(kind, ResourceKind::Texture { .. })),
        limits.max_sampled_textures_per_shader_stage.into(),
    )?;
    need("max_samplers_per_shader_stage", "samplers").require(
        what,
        count(|kind| matches!(kind, ResourceKind::Sampler)),
        limits.max_samplers_per_shader_stage.into(),
    )
}

fn workgroup_fits(what: &str, size: [u32; 3], limits: &wgpu::Limits) -> Result<(), Error> {
    let need = |limit| Need { limit, unit: "invocations a workgroup", cure: "" };
    let all = size.iter().map(|&n| u64::from(n)).product();
    need("max_compute_invocations_per_workgroup").require(what, all, limits.max_compute_invocations_per_workgroup.into())?;
    let across = [
        ("max_compute_workgroup_size_x", limits.max_compute_workgroup_size_x),
        ("max_compute_workgroup_size_y", limits.max_compute_workgroup_size_y),
        ("max_compute_workgroup_size_z", limits.max_compute_workgroup_size_z),
    ];
    for ((limit, offered), needed) in across.into_iter().zip(size) {
        need(limit).require(what, needed.into(), offered.into())?;
    }
    Ok(())
}

fn dispatches_fit(step: &Step, interface: &Interface, size: [u32; 2], limits: &wgpu::Limits) -> Result<(), Error> {
    let need = Need { limit: "max_compute_workgroups_per_dimension", unit: "workgroups in one dimension", cure: "" };
    let offered = limits.max_compute_workgroups_per_dimension.into();
    for entry in interface.entries.iter().filter(|entry| entry.stage == Stage::Compute) {
        let groups = workgroups(&covered(entry, interface, step), size, entry.workgroup_size);
        let most = groups.into_iter().max().unwrap_or(0);
        need.require(&format!("entry point `{}` of pass `{}`", entry.name, step.node), most.into(), offered)?;
    }
    Ok(())
}

/// What one entry point runs over: the first port that it writes, else the first that the pass writes, else the pixels.
pub(crate) fn covered(entry: &Entry, interface: &Interface, step: &Step) -> Extent {
    let extent = |name: &str| {
        let port = step.contract.ports.iter().find(|port| port.name == name)?;
        (port.direction != aquifer_graph::Direction::In).then(|| port.ty.extent.clone())
    };
    let own = entry.bindings.iter().map(|&index| &interface.bindings[index]).filter(|binding| binding.group == 1);
    let all = step.contract.ports.iter().map(|port| port.name.as_str());
    own.map(|binding| binding.name.as_str()).chain(all).find_map(extent).unwrap_or(Extent::Pixels)
}

/// Workgroups that cover an extent: two-dimensional for pixels and tiles, one-dimensional for a fixed number.
pub(crate) fn workgroups(extent: &Extent, size: [u32; 2], workgroup: [u32; 3]) -> [u32; 3] {
    let [w, h] = match *extent {
        Extent::Pixels => size,
        Extent::Tiles(w, h) => [size[0].div_ceil(w), size[1].div_ceil(h)],
        Extent::Fixed(n) => return [n.div_ceil(workgroup[0].max(1)), 1, 1],
    };
    [w.div_ceil(workgroup[0].max(1)), h.div_ceil(workgroup[1].max(1)), 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_is_covered_and_no_workgroup_is_wholly_outside() {
        assert_eq!(workgroups(&Extent::Pixels, [17, 8], [8, 8, 1]), [3, 1, 1]);
        assert_eq!(workgroups(&Extent::Pixels, [100, 3], [64, 1, 1]), [2, 3, 1]);
        assert_eq!(workgroups(&Extent::Tiles(64, 32), [65, 32], [8, 8, 1]), [1, 1, 1]);
        assert_eq!(workgroups(&Extent::Tiles(64, 32), [1920, 1080], [8, 8, 1]), [4, 5, 1]);
        assert_eq!(workgroups(&Extent::Fixed(129), [1, 1], [64, 1, 1]), [3, 1, 1]);
    }

    #[test]
    fn a_need_is_an_error_only_when_it_is_greater() {
        assert!(BUFFER_SIZE.require("a", 8, 8).is_ok());
        let text = BUFFER_SIZE.require("resource `a.b`", 9, 8).unwrap_err().to_string();
        assert_eq!(text, "resource `a.b` needs 9 bytes, but the adapter offers 8 (max_buffer_size); a smaller --size needs less");
    }
}
