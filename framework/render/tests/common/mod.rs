//! Tiny passes, and graphs of them.

#![allow(dead_code, reason = "each test file uses its own part of this")]

use aquifer_graph::{Document, Graph, NeedsAll, Plan, Shelf};
use aquifer_render::{Context, Error, FrameInfo, Globals, PassKind, Registry, Renderer, RendererOptions};
use aquifer_shader::Library;
use std::{
    collections::BTreeSet,
    sync::{Arc, OnceLock},
};

/// The frame as the tiny passes know it.
const FRAME: &str = "
struct Frame { extent: vec2<u32>, index: u32, history_valid: u32 }
@group(0) @binding(0) var<uniform> frame: Frame;
/// Beyond every array for what lies beyond the image.
fn at(id: vec3<u32>) -> u32 { return select(0xffffffffu, id.y * frame.extent.x + id.x, all(id.xy < frame.extent)); }
";

const PREAMBLE: &str = "import package::test::frame::{frame, at};\n";

/// Name and text of every tiny pass; `BODY` of each runs for one pixel `i`.
const PASSES: &[(&str, &str, &str)] = &[
    (
        "count",
        "/// @optional\n@group(1) @binding(0) var<storage, read> before: array<vec4<f32>>;\n\
         @group(1) @binding(1) var<storage, read_write> after: array<vec4<f32>>;\n",
        "after[i] = before[i] + 1.0;",
    ),
    ("source", "@group(1) @binding(0) var<storage, read_write> value: array<vec4<f32>>;\n", "value[i] = vec4<f32>(f32(frame.index));"),
    (
        "copy",
        "@group(1) @binding(0) var<storage, read> value: array<vec4<f32>>;\n\
         @group(1) @binding(1) var<storage, read_write> image: array<vec4<f32>>;\n",
        "image[i] = value[i];",
    ),
    (
        "position",
        "@group(1) @binding(0) var<storage, read_write> image: array<vec4<f32>>;\n",
        "image[i] = vec4<f32>(f32(id.x), f32(id.y), f32(i), f32(arrayLength(&image)));",
    ),
    (
        "lengths",
        "/// @optional\n@group(1) @binding(0) var<storage, read> absent: array<vec2<f32>>;\n\
         @group(1) @binding(1) var<storage, read_write> image: array<vec4<f32>>;\n",
        "image[i] = vec4<f32>(f32(arrayLength(&absent)), absent[i], f32(arrayLength(&image)));",
    ),
    (
        "gaps",
        "@group(1) @binding(0) var<storage, read_write> value: array<vec4<f32>>;\n",
        "if (i % 2u == 0u) { value[i] = vec4<f32>(7.0); }",
    ),
    (
        // A NaN in pixel 3, in words that are floats and in one that is not; infinities in the row above the last.
        "sick",
        "struct Mixed { id: u32, pair: vec2<f32>, _pad: u32 }\n\
         @group(1) @binding(0) var<storage, read_write> mixed: array<Mixed>;\n\
         @group(1) @binding(1) var<storage, read_write> value: array<vec4<f32>>;\n",
        "let nan = bitcast<f32>(0x7fc00000u | i); let infinite = bitcast<f32>(0xff800000u | (frame.index & 0u));\n\
         mixed[i] = Mixed(0x7fc00000u, vec2<f32>(1.0, select(1.0, nan, i == 3u)), 0x7f800000u);\n\
         value[i] = vec4<f32>(1.0, 2.0, select(3.0, infinite, id.y == frame.extent.y - 2u), 3.0e38);",
    ),
    (
        "scale",
        "struct Params {\n/// @default 2\n/// @range 0 100\ngain: f32,\n/// @default 3\noffset: u32,\n}\n\
         @group(1) @binding(0) var<uniform> params: Params;\n\
         @group(1) @binding(1) var<storage, read> value: array<vec4<f32>>;\n\
         @group(1) @binding(2) var<storage, read_write> image: array<vec4<f32>>;\n\
         override power: u32 = 1u;\n",
        "image[i] = pow(value[i], vec4<f32>(f32(power))) * params.gain + f32(params.offset);",
    ),
    (
        "stage",
        "override random_stage: u32 = 0u;\n@group(1) @binding(0) var<storage, read_write> value: array<vec4<f32>>;\n",
        "value[i] = vec4<f32>(f32(random_stage & 0xffffu), f32(random_stage >> 16u), 0.0, 0.0);",
    ),
    (
        "bloated",
        "var<workgroup> large: array<f32, 1000000>;\n@group(1) @binding(0) var<storage, read_write> value: array<vec4<f32>>;\n",
        "large[i] = 1.0; value[i] = vec4<f32>(large[i / 2u]);",
    ),
    (
        "incomplete",
        "override nobody_sets: f32;\n@group(1) @binding(0) var<storage, read_write> value: array<vec4<f32>>;\n",
        "value[i] = vec4<f32>(nobody_sets);",
    ),
    (
        "chase",
        "struct Params {\n/// @default 1\nsteps: u32,\n}\n@group(1) @binding(0) var<uniform> params: Params;\n\
         @group(1) @binding(1) var<storage, read> value: array<vec4<f32>>;\n\
         @group(1) @binding(2) var<storage, read_write> image: array<vec4<f32>>;\n",
        // llvmpipe ends loops after 65,535 rounds: long work needs many pixels too.
        "var x = u32(value[i].x) + i + 1u;\n\
         for (var n = 0u; n < params.steps; n++) { x ^= x << 13u; x ^= x >> 17u; x ^= x << 5u; }\n\
         image[i] = vec4<f32>(f32(x));",
    ),
];

/// Passes whose whole text matters.
const WHOLE: &[(&str, &str)] = &[
    (
        // Instance 0 covers the image, instance 1 the first six columns, nearer.
        "paint",
        "@group(1) @binding(0) var<storage, read_write> image: array<vec4<f32>>;\n\
         @group(1) @binding(1) var drawn: texture_2d<u32>;\n\
         struct Corner { @builtin(position) place: vec4<f32>, @location(0) @interpolate(flat) id: u32 }\n\
         struct Given { @location(0) drawn: vec2<u32>, @builtin(frag_depth) depth: f32 }\n\
         @vertex fn corner(@builtin(vertex_index) v: u32, @builtin(instance_index) id: u32) -> Corner {\n\
         let p = vec2<f32>(f32(v & 1u), f32(v >> 1u)) * 4.0 - 1.0;\n\
         return Corner(vec4<f32>(p, 0.0, 1.0), id); }\n\
         @fragment fn ids(c: Corner) -> Given { if (c.id == 1u && c.place.x > 6.0) { discard; }\n\
         return Given(vec2<u32>(c.id + 1u, 7u), 0.25 * f32(c.id + 1u)); }\n\
         @compute @workgroup_size(8, 8) fn look(@builtin(global_invocation_id) id: vec3<u32>) {\n\
         if (any(id.xy >= frame.extent)) { return; }\n\
         image[at(id)] = vec4<f32>(textureLoad(drawn, id.xy, 0)); }\n",
    ),
    (
        "tiles",
        "/// @extent tiles 4 2\n@group(1) @binding(0) var<storage, read_write> tile: array<vec2<f32>>;\n\
         @compute @workgroup_size(2, 2) fn main(@builtin(global_invocation_id) id: vec3<u32>) {\n\
         let grid = (frame.extent + vec2<u32>(3u, 1u)) / vec2<u32>(4u, 2u);\n\
         if (all(id.xy < grid)) { tile[id.y * grid.x + id.x] = vec2<f32>(id.xy); } }\n",
    ),
    (
        "tiles_seen",
        "/// @extent tiles 4 2\n@group(1) @binding(0) var<storage, read> tile: array<vec2<f32>>;\n\
         /// @extent fixed 9\n@group(1) @binding(1) var<storage, read_write> list: array<vec2<f32>>;\n\
         @compute @workgroup_size(4) fn main(@builtin(global_invocation_id) id: vec3<u32>) {\n\
         if (id.x < arrayLength(&tile)) { list[id.x] = tile[id.x] + f32(frame.index) * 0.0; } }\n",
    ),
    (
        "two_steps",
        "/// @optional\n@group(1) @binding(0) var<storage, read_write> notes: array<vec4<f32>>;\n\
         @group(1) @binding(1) var<storage, read_write> image: array<vec4<f32>>;\n\
         @compute @workgroup_size(8, 8) fn note(@builtin(global_invocation_id) id: vec3<u32>) {\n\
         let i = at(id); if (i < arrayLength(&notes)) { notes[i] += 5.0; } }\n\
         @compute @workgroup_size(8, 8) fn show(@builtin(global_invocation_id) id: vec3<u32>) {\n\
         let i = at(id); if (i < arrayLength(&image)) { image[i] = notes[arrayLength(&image) - 1u - i] * 2.0; } }\n",
    ),
    (
        "greedy",
        "@group(1) @binding(0) var<storage, read_write> a: array<vec4<f32>>;\n@group(1) @binding(1) var<storage, read_write> b: array<vec4<f32>>;\n\
         @group(1) @binding(2) var<storage, read_write> c: array<vec4<f32>>;\n@group(1) @binding(3) var<storage, read_write> d: array<vec4<f32>>;\n\
         @group(1) @binding(4) var<storage, read_write> e: array<vec4<f32>>;\n@group(1) @binding(5) var<storage, read_write> f: array<vec4<f32>>;\n\
         @group(1) @binding(6) var<storage, read_write> g: array<vec4<f32>>;\n@group(1) @binding(7) var<storage, read_write> h: array<vec4<f32>>;\n\
         @group(1) @binding(8) var<storage, read_write> value: array<vec4<f32>>;\n\
         @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {\n\
         let i = at(id); let x = vec4<f32>(1.0); a[i] = x; b[i] = x; c[i] = x; d[i] = x; e[i] = x; f[i] = x; g[i] = x; h[i] = x; value[i] = x; }\n",
    ),
];

/// A library of the tiny passes.
pub fn library() -> Arc<Library> {
    let mut library = Library::new();
    library.insert("test/frame", FRAME, "frame.wgsl");
    for (name, declarations, body) in PASSES {
        let main = format!(
            "@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{\n\
             if (any(id.xy >= frame.extent)) {{ return; }}\nlet i = at(id);\n{body}\n}}\n"
        );
        library.insert(format!("pass/{name}"), format!("{PREAMBLE}{declarations}{main}"), format!("{name}.wgsl"));
    }
    for (name, text) in WHOLE {
        library.insert(format!("pass/{name}"), format!("{PREAMBLE}{text}"), format!("{name}.wgsl"));
    }
    Arc::new(library)
}

/// The tiny passes, and kinds with host code.
pub fn registry(kinds: &[PassKind]) -> Registry {
    Registry::new(library(), kinds, BTreeSet::new())
}

/// The plan of a graph's text, after its head.
pub fn plan(registry: &Registry, output: &str, passes: &str, keep: &[&str]) -> Plan {
    let text = format!("title = \"test\"\ntransport = \"direct\"\noutput = \"{output}\"\n{passes}");
    let document = Document::load("test:graph.toml", &Shelf::new("test", [("graph.toml", text)])).expect("the graph is well-formed");
    let graph = Graph::check(&document, registry).unwrap_or_else(|faults| panic!("{faults:?}"));
    graph.plan(&NeedsAll, keep).expect("the graph has a plan")
}

/// One device for all tests of a process: drivers compile slowly, and pipelines are shared.
pub fn context() -> &'static Context {
    static CONTEXT: OnceLock<Context> = OnceLock::new();
    CONTEXT.get_or_init(|| Context::new(&Default::default()).unwrap_or_else(|error| panic!("these tests need an adapter: {error}")))
}

/// The frame uniform of the tiny passes.
pub struct TestGlobals {
    buffer: wgpu::Buffer,
}

impl TestGlobals {
    /// Not yet filled.
    pub fn new(context: &Context) -> Box<Self> {
        let buffer = context.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("frame"),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Box::new(TestGlobals { buffer })
    }
}

impl Globals for TestGlobals {
    fn advance(&mut self, context: &Context, frame: &FrameInfo) -> Result<(), Error> {
        let words = [frame.size[0], frame.size[1], frame.index, u32::from(frame.history_valid)];
        context.queue().write_buffer(&self.buffer, 0, bytemuck::cast_slice(&words));
        Ok(())
    }

    fn resource(&self, module: &str, name: &str) -> Option<wgpu::BindingResource<'_>> {
        (module == "test/frame" && name == "frame").then(|| self.buffer.as_entire_binding())
    }
}

/// A renderer of a plan on the shared device.
pub fn renderer(registry: &Registry, plan: Plan, options: RendererOptions) -> Renderer {
    let context = context();
    Renderer::new(context, registry, plan, TestGlobals::new(context), options).unwrap_or_else(|error| panic!("{error}"))
}

/// Options of a small image.
pub fn small() -> RendererOptions {
    RendererOptions { size: [13, 9], ..Default::default() }
}

/// Renders so many frames.
pub fn render(renderer: &mut Renderer, frames: u32) {
    for _ in 0..frames {
        renderer.frame().unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Every component of every pixel.
pub fn pixels(renderer: &mut Renderer, name: &str) -> Vec<[f32; 4]> {
    let floats = renderer.read_f32(name).unwrap_or_else(|error| panic!("{error}"));
    floats.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]]).collect()
}
