//! Images that a pass draws into and then reads: private to the pass, one texel a pixel, named as the fragment entry points name what they give.

use crate::{Context, Error, ResourceMemory, limits::Need};
use aquifer_shader::{Interface, Output, Stage};

/// Nearest is largest, so that `near / distance` keeps the relative precision of a float at every distance.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

const WIDEST: Need = Need { limit: "max_texture_dimension_2d", unit: "pixels across or down", cure: "; a smaller --size needs less" };

/// What a shader's fragment entry points give, each name once.
pub(crate) fn outputs(interface: &Interface) -> Vec<&Output> {
    let fragments = interface.entries.iter().filter(|entry| entry.stage == Stage::Fragment);
    let mut found: Vec<&Output> = Vec::new();
    for output in fragments.flat_map(|entry| &entry.outputs) {
        if !found.iter().any(|known| known.name == output.name) {
            found.push(output);
        }
    }
    found
}

/// The format that keeps every bit of a value of this type.
pub(crate) fn format(node: &str, output: &Output) -> Result<wgpu::TextureFormat, Error> {
    use wgpu::TextureFormat as Format;
    Ok(match output.ty.as_str() {
        "u32" => Format::R32Uint,
        "i32" => Format::R32Sint,
        "f32" => Format::R32Float,
        "vec2<u32>" => Format::Rg32Uint,
        "vec2<i32>" => Format::Rg32Sint,
        "vec2<f32>" => Format::Rg32Float,
        "vec4<u32>" => Format::Rgba32Uint,
        "vec4<i32>" => Format::Rgba32Sint,
        "vec4<f32>" => Format::Rgba32Float,
        other => {
            let message = format!("fragment output `{}` is {other}: an image holds one, two or four of f32, i32 or u32", output.name);
            return Err(Error::Validation { pass: node.to_owned(), message });
        }
    })
}

/// The images of one node.
#[derive(Debug)]
pub(crate) struct Targets {
    images: Vec<Image>,
}

#[derive(Debug)]
struct Image {
    name: String,
    view: wgpu::TextureView,
    memory: ResourceMemory,
}

impl Targets {
    /// One image for each name, and one for depth where anything is drawn at all.
    pub fn new(context: &Context, node: &str, interface: &Interface, size: [u32; 2]) -> Result<Targets, Error> {
        let outputs = outputs(interface);
        let mut formats = Vec::new();
        for output in &outputs {
            formats.push((output.name.as_str(), format(node, output)?));
        }
        if interface.entries.iter().any(|entry| entry.stage == Stage::Fragment) {
            formats.push((Self::DEPTH, DEPTH));
        }
        let image = |(name, format)| image(context, node, name, format, size);
        Ok(Targets { images: formats.into_iter().map(image).collect::<Result<_, Error>>()? })
    }

    /// The name of the depth image, which no fragment output can have.
    const DEPTH: &str = "(depth)";

    /// The image of a fragment output.
    pub fn view(&self, name: &str) -> Option<&wgpu::TextureView> {
        self.images.iter().find(|image| image.name == name).map(|image| &image.view)
    }

    pub fn depth(&self) -> Option<&wgpu::TextureView> {
        self.view(Self::DEPTH)
    }

    /// Where memory goes.
    pub fn memory(&self) -> impl Iterator<Item = ResourceMemory> {
        self.images.iter().map(|image| image.memory.clone())
    }
}

fn image(context: &Context, node: &str, name: &str, format: wgpu::TextureFormat, [width, height]: [u32; 2]) -> Result<Image, Error> {
    let label = format!("{node}.{name}");
    let offered = context.limits().max_texture_dimension_2d;
    WIDEST.require(&format!("image `{label}`"), width.max(height).into(), offered.into())?;
    let texture = context.guard(&format!("image `{label}`"), || {
        context.device().create_texture(&wgpu::TextureDescriptor {
            label: Some(&label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })
    })?;
    // Depth32Float has no copy size of its own: four bytes are what it takes.
    let bytes = u64::from(format.block_copy_size(None).unwrap_or(4)) * u64::from(width) * u64::from(height);
    let memory = ResourceMemory { name: label, bytes, life: "image", block: None };
    Ok(Image { name: name.to_owned(), view: texture.create_view(&wgpu::TextureViewDescriptor::default()), memory })
}
