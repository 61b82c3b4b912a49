//! Where the scene's arrays lie: in buffers, or in textures that shaders read as `base/table` says.

use crate::{BINDING_SIZE, Context, Error, limits::TABLE_ROWS};
use wgpu::util::DeviceExt;

/// `base/table::ROW`.
const ROW: usize = 8192;

/// Words of a texel are 4 bytes each.
const TEXEL: usize = 16;

/// An array on the device.
pub enum Store {
    /// A storage or uniform buffer.
    Buffer(wgpu::Buffer),
    /// Rows of texels, and their view.
    Table(wgpu::Texture, wgpu::TextureView),
}

impl Store {
    /// A buffer of records, never empty: bindings must hold at least one element.
    pub fn buffer<T: bytemuck::Pod>(context: &Context, name: &str, records: &[T], usage: wgpu::BufferUsages) -> Result<Store, Error> {
        let zero = [T::zeroed()];
        let contents: &[u8] = bytemuck::cast_slice(if records.is_empty() { &zero } else { records });
        BINDING_SIZE.require(&format!("the scene's `{name}`"), contents.len() as u64, context.limits().max_storage_buffer_binding_size)?;
        context.guard(name, || {
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            Store::Buffer(context.device().create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(name), contents, usage }))
        })
    }

    /// A table of records; what the last texel has left is zeros.
    pub fn table<T: bytemuck::Pod>(context: &Context, name: &str, records: &[T]) -> Result<Store, Error> {
        let contents: &[u8] = bytemuck::cast_slice(records);
        let size = extent(contents.len());
        TABLE_ROWS.require(&format!("the scene's `{name}`"), size.height.into(), context.limits().max_texture_dimension_2d.into())?;
        let store = context.guard(name, || {
            let texture = context.device().create_texture(&wgpu::TextureDescriptor {
                label: Some(name),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba32Uint,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            Store::Table(texture, view)
        })?;
        store.write(context, contents);
        Ok(store)
    }

    /// Replaces the beginning.
    pub fn write(&self, context: &Context, bytes: &[u8]) {
        match self {
            Store::Buffer(buffer) => context.queue().write_buffer(buffer, 0, bytes),
            Store::Table(texture, _) => write_rows(context, texture, bytes),
        }
    }

    /// As it is bound.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        match self {
            Store::Buffer(buffer) => buffer.as_entire_binding(),
            Store::Table(_, view) => wgpu::BindingResource::TextureView(view),
        }
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        match self {
            Store::Buffer(buffer) => buffer.size(),
            Store::Table(texture, _) => u64::from(texture.width()) * u64::from(texture.height()) * TEXEL as u64,
        }
    }
}

/// Texels across and down for so many bytes: one row, or full rows.
fn extent(bytes: usize) -> wgpu::Extent3d {
    let texels = bytes.div_ceil(TEXEL).max(1);
    wgpu::Extent3d { width: texels.min(ROW) as u32, height: texels.div_ceil(ROW) as u32, depth_or_array_layers: 1 }
}

/// Full rows, then what is left.
fn write_rows(context: &Context, texture: &wgpu::Texture, bytes: &[u8]) {
    let (full, rest) = bytes.split_at(bytes.len() / (ROW * TEXEL) * ROW * TEXEL);
    for (part, row) in [(full, 0), (rest, full.len() / (ROW * TEXEL))] {
        if part.is_empty() {
            continue;
        }
        let origin = wgpu::Origin3d { x: 0, y: row as u32, z: 0 };
        let place = wgpu::TexelCopyTextureInfo { texture, mip_level: 0, origin, aspect: wgpu::TextureAspect::All };
        let mut part = part.to_vec();
        part.resize(part.len().next_multiple_of(TEXEL), 0);
        let size = extent(part.len());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size.width * TEXEL as u32), rows_per_image: None };
        context.queue().write_texture(place, &part, layout, size);
    }
}
