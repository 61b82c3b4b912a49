//! Where there is no adapter, nothing is tested.

/// Is there one? Where one is required, its absence is a failure.
pub fn has_adapter() -> bool {
    let found = !aquifer_render::adapters().is_empty();
    assert!(found || std::env::var_os("AQUIFER_REQUIRE_ADAPTER").is_none(), "no adapter");
    found
}
