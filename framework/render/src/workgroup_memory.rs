//! Memory that the invocations of a workgroup share. wgpu does not hold pipelines to its limit, and drivers fail in their own ways.

use crate::{Error, limits::Need};
use aquifer_shader::Composed;

const NEED: Need = Need { limit: "max_compute_workgroup_storage_size", unit: "bytes of workgroup memory", cure: "" };

/// Whether every entry point of pass `node` gets along with the memory of a workgroup. Arrays whose length is an `override` count as empty.
///
/// # Errors
/// [`Error::LimitTooSmall`] names the entry point.
pub(crate) fn check(node: &str, shader: &Composed, limits: &wgpu::Limits) -> Result<(), Error> {
    for (entry, bytes) in by_entry(&shader.module) {
        let what = format!("entry point `{entry}` of pass `{node}`");
        NEED.require(&what, bytes, limits.max_compute_workgroup_storage_size.into())?;
    }
    Ok(())
}

fn by_entry(module: &naga::Module) -> Vec<(&str, u64)> {
    let is_shared = |variable: &naga::GlobalVariable| variable.space == naga::AddressSpace::WorkGroup;
    let shared: Vec<_> = module.global_variables.iter().filter(|(_, variable)| is_shared(variable)).collect();
    if shared.is_empty() {
        return Vec::new();
    }
    let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
    // Composed modules are valid; what is not is refused when its pipeline is made.
    let Ok(info) = validator.validate(module) else { return Vec::new() };
    let bytes = |variable: &naga::GlobalVariable| u64::from(module.types[variable.ty].inner.try_size(module.to_ctx()).unwrap_or(u32::MAX));
    let reached = |index: usize| {
        let uses = info.get_entry_point(index);
        shared.iter().filter(|(handle, _)| !uses[*handle].is_empty()).map(|(_, variable)| bytes(variable)).sum()
    };
    module.entry_points.iter().enumerate().map(|(index, entry)| (entry.name.as_str(), reached(index))).collect()
}

#[cfg(test)]
mod tests {
    use super::by_entry;

    #[test]
    fn each_entry_point_counts_what_it_reaches() {
        let text = "var<workgroup> a: array<vec4<f32>, 10>;\nvar<workgroup> b: u32;\nfn touch() { b = 1u; }\n\
                    @compute @workgroup_size(1) fn both() { a[0].x = 1.0; touch(); }\n\
                    @compute @workgroup_size(1) fn one() { touch(); }\n@compute @workgroup_size(1) fn none() {}\n";
        let module = naga::front::wgsl::parse_str(text).unwrap();
        assert_eq!(by_entry(&module), [("both", 164), ("one", 4), ("none", 0)]);
    }
}
