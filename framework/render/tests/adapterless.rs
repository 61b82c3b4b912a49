//! What can be said without a driver: adapters that are not there, limits that are too small, pipelines that are checked and not run.

mod common;

use aquifer_graph::{Contracts, Direction, Slots};
use aquifer_render::{Clock, Context, ContextOptions, Error, LimitChoice, Renderer, RendererOptions};
use common::{TestGlobals, plan, registry, small};

fn small_device() -> Context {
    Context::noop(wgpu::Limits::default()).unwrap()
}

fn refused(context: &Context, output: &str, passes: &str, size: [u32; 2]) -> Error {
    let registry = registry(&[]);
    let plan = plan(&registry, output, passes, &[]);
    let options = RendererOptions { size, ..small() };
    Renderer::new(context, &registry, plan, TestGlobals::new(context), options).map(drop).expect_err("the device is too small")
}

#[test]
fn an_adapter_that_is_not_there_is_refused_with_those_that_are() {
    let options = ContextOptions { adapter: Some("no such thing".to_owned()), ..Default::default() };
    match Context::new(&options) {
        Err(Error::NoSuchAdapter { wanted, .. }) => assert_eq!(wanted, "no such thing"),
        Err(Error::NoAdapter) => {}
        other => panic!("{other:?}"),
    }
    assert!(Error::NoAdapter.to_string().contains("apt install mesa-vulkan-drivers"));
}

#[test]
fn a_resource_beyond_the_limits_is_named_with_needed_and_offered_bytes() {
    let error = refused(&small_device(), "source.value", "[pass.source]\n", [4096, 4096]);
    assert_eq!(
        error.to_string(),
        "resource `source.value` needs 268435456 bytes, but the adapter offers 134217728 (max_storage_buffer_binding_size); \
         a smaller --size needs less"
    );
    assert!(!error.is_temporary());
    let error = refused(&small_device(), "lengths.image", "[pass.lengths]\n", [3000, 2797]);
    assert!(error.to_string().contains("`lengths.image` needs"), "{error}");
}

#[test]
fn too_many_bindings_are_named_with_their_entry_point() {
    let passes = "[pass.greedy]\n";
    let error = refused(&small_device(), "greedy.value", passes, [8, 8]);
    assert_eq!(
        error.to_string(),
        "entry point `main` of pass `greedy` needs 9 storage buffers, but the adapter offers 8 (max_storage_buffers_per_shader_stage)"
    );
    let large = Context::noop(wgpu::Limits { max_storage_buffers_per_shader_stage: 9, ..Default::default() }).unwrap();
    let registry = registry(&[]);
    let plan = plan(&registry, "greedy.value", passes, &[]);
    Renderer::new(&large, &registry, plan, TestGlobals::new(&large), small()).unwrap();
}

#[test]
fn too_much_workgroup_memory_is_named_with_its_entry_point() {
    let error = refused(&small_device(), "big.value", "[pass.big]\nkind = \"bloated\"\n", [8, 8]);
    assert_eq!(
        error.to_string(),
        "entry point `main` of pass `big` needs 4000000 bytes of workgroup memory, but the adapter offers 16384 \
         (max_compute_workgroup_storage_size)"
    );
}

#[test]
fn an_empty_image_is_refused() {
    let error = refused(&small_device(), "source.value", "[pass.source]\n", [0, 8]);
    assert_eq!(error.to_string(), "an image of 0x8 pixels is empty");
}

#[test]
fn frames_are_recorded_and_checked_without_a_driver() {
    let context = small_device();
    let registry = registry(&[]);
    let plan = plan(&registry, "count.after", "[pass.count]\nin.before = \"count.after@prev\"\n", &[]);
    let mut renderer = Renderer::new(&context, &registry, plan, TestGlobals::new(&context), small()).unwrap();
    for _ in 0..4 {
        renderer.frame().unwrap();
    }
    assert_eq!(renderer.read("count.after").unwrap().len(), 13 * 9 * 16);
    assert_eq!(renderer.memory().resources[0].life, "history");
    let timings = renderer.timings();
    assert_eq!((timings.clock, timings.frames), (Clock::Wall, 3), "a device without timestamps is timed by the host");
    assert!(timings.passes[0].median_ms.is_some());
}

#[test]
fn a_lost_device_is_an_error_that_may_pass() {
    let context = small_device();
    let registry = registry(&[]);
    let plan = plan(&registry, "source.value", "[pass.source]\n", &[]);
    let mut renderer = Renderer::new(&context, &registry, plan, TestGlobals::new(&context), small()).unwrap();
    renderer.frame().unwrap();
    context.device().destroy();
    context.device().poll(wgpu::PollType::Poll).unwrap();
    let error = renderer.frame().unwrap_err();
    assert!(matches!(error, Error::DeviceLost { .. }), "{error}");
    assert!(error.is_temporary());
}

#[test]
fn a_webgpu_sized_device_can_be_asked_for() {
    let options = ContextOptions { limits: LimitChoice::WebGpu, ..Default::default() };
    match Context::new(&options) {
        Ok(context) => assert!(context.limits().max_storage_buffers_per_shader_stage <= 8),
        Err(Error::NoAdapter) => {}
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn contracts_follow_from_shaders() {
    let registry = registry(&[]);
    assert!(registry.kinds().contains(&"scale".to_owned()));
    let contract = registry.contract("scale", &Slots::new()).unwrap();
    let ports: Vec<_> = contract.ports.iter().map(|port| (port.name.as_str(), port.direction)).collect();
    assert_eq!(ports, [("value", Direction::In), ("image", Direction::Out)]);
    let params: Vec<_> = contract.params.iter().map(|param| (param.name.as_str(), param.live)).collect();
    assert_eq!(params, [("gain", true), ("offset", true), ("power", false)]);
    assert!(registry.contract("stage", &Slots::new()).unwrap().params.is_empty(), "the host alone sets `random_stage`");
    let error = registry.contract("scala", &Slots::new()).unwrap_err();
    assert_eq!(error.to_string(), "no pass of kind `scala`");
}
