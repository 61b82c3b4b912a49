//! What a window would show: egui's own renderer on the device that the viewer renders with.

use aquifer_render::{Context, ContextOptions};
use eframe::egui;
use egui_kittest::TestRenderer;
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use image::RgbaImage;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Rows of a texture are copied in multiples of this.
const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

pub struct Screen {
    context: Context,
    renderer: Renderer,
}

impl Screen {
    pub fn new() -> Self {
        let context = Context::new(&ContextOptions::default()).unwrap();
        let renderer = Renderer::new(context.device(), FORMAT, RendererOptions::PREDICTABLE);
        Self { context, renderer }
    }
}

impl TestRenderer for Screen {
    fn handle_delta(&mut self, delta: &mut egui::TexturesDelta) {
        for (id, images) in delta.set.drain() {
            for image in images {
                self.renderer.update_texture(self.context.device(), self.context.queue(), id, &image);
            }
        }
        delta.free.drain().for_each(|id| self.renderer.free_texture(&id));
    }

    fn render(&mut self, ctx: &egui::Context, output: &egui::FullOutput) -> Result<RgbaImage, String> {
        let (device, queue) = (self.context.device(), self.context.queue());
        let points = ctx.pixels_per_point();
        let [width, height] = (ctx.content_rect().size() * points).into();
        let size_in_pixels = [width.round() as u32, height.round() as u32];
        let screen = ScreenDescriptor { pixels_per_point: points, size_in_pixels };
        let shapes = ctx.tessellate(output.shapes.clone(), points);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let commands = self.renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
        let [width, height] = size_in_pixels;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("window"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let target = wgpu::RenderPassColorAttachment {
            view: &view,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            depth_slice: None,
        };
        let descriptor = wgpu::RenderPassDescriptor { color_attachments: &[Some(target)], ..Default::default() };
        self.renderer.render(&mut encoder.begin_render_pass(&descriptor).forget_lifetime(), &shapes, &screen);
        let row = (4 * width).next_multiple_of(ROW);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("window"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(height) };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), wgpu::TexelCopyBufferInfo { buffer: &buffer, layout }, texture.size());
        queue.submit(commands.into_iter().chain([encoder.finish()]));
        let bytes = aquifer_render::read(&self.context, "window", &buffer, 0, buffer.size()).map_err(|error| error.to_string())?;
        let rows = bytes.chunks_exact(row as usize).flat_map(|bytes| &bytes[..4 * width as usize]).copied().collect();
        RgbaImage::from_raw(width, height, rows).ok_or_else(|| "sizes differ".to_owned())
    }
}
