//! One fragment entry point behind its shader's vertex entry point, ready to draw.

use crate::{
    Context, Error,
    limits::Need,
    program::{Program, Recipe, find},
    stamps::Stamp,
    targets::{self, Targets},
};
use aquifer_shader::{Composed, Entry, Output, Stage};
use std::ops::Range;

/// Triangles drawn together: `vertices` of each of `instances`. The vertex entry point finds its corners by these numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Batch {
    /// Three a triangle.
    pub vertices: Range<u32>,
    /// All of the same vertices.
    pub instances: Range<u32>,
}

/// A pipeline with where its outputs go.
#[derive(Debug)]
pub(crate) struct Drawing {
    entry: String,
    /// By location.
    outputs: Vec<Option<Output>>,
    program: Program<wgpu::RenderPipeline>,
}

impl Drawing {
    /// Compiles a fragment entry point. Both sides of triangles are drawn, and what is nearest stays.
    pub fn new(context: &Context, label: &str, composed: &Composed, fragment: &Entry, constants: &[(&str, f64)]) -> Result<Drawing, Error> {
        let vertex = composed.interface.entries.iter().find(|entry| entry.stage == Stage::Vertex);
        let vertex = vertex.map_or_else(|| find(label, composed, Stage::Vertex, "(any)"), Ok)?;
        let entries = [vertex, fragment];
        let outputs = by_location(context, label, fragment)?;
        let state = |output: &Option<Output>| output.as_ref().map(|output| Ok(targets::format(label, output)?.into())).transpose();
        let states = outputs.iter().map(state).collect::<Result<Vec<Option<wgpu::ColorTargetState>>, Error>>()?;
        let recipe = Recipe::new(context, label, composed, &entries, constants)?;
        let program = recipe.program(&context.pipelines().render, |with| {
            with.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: with.label,
                layout: Some(with.layout),
                vertex: wgpu::VertexState {
                    module: with.module,
                    entry_point: Some(&vertex.name),
                    compilation_options: with.options.clone(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(nearest()),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: with.module,
                    entry_point: Some(&fragment.name),
                    compilation_options: with.options,
                    targets: &states,
                }),
                multiview_mask: None,
                cache: None,
            })
        })?;
        Ok(Drawing { entry: fragment.name.clone(), outputs, program })
    }

    /// The fragment entry point's name.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    pub fn program(&self) -> &Program<wgpu::RenderPipeline> {
        &self.program
    }

    /// Records one wgpu pass: images and depth become zeros, then every batch is drawn.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        groups: &[Option<&wgpu::BindGroup>],
        batches: &[Batch],
        stamp: Option<Stamp<'_>>,
    ) {
        let images: Vec<_> = self.outputs.iter().map(|output| targets.view(&output.as_ref()?.name).map(cleared)).collect();
        let depth = targets.depth().map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.program.label()),
            color_attachments: &images,
            depth_stencil_attachment: depth,
            timestamp_writes: stamp.map(Stamp::render),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(self.program.pipeline());
        for (index, group) in (0..).zip(groups) {
            if let Some(group) = group {
                pass.set_bind_group(index, *group, &[]);
            }
        }
        for batch in batches {
            pass.draw(batch.vertices.clone(), batch.instances.clone());
        }
    }
}

fn by_location(context: &Context, label: &str, fragment: &Entry) -> Result<Vec<Option<Output>>, Error> {
    let count = fragment.outputs.iter().map(|output| output.location + 1).max().unwrap_or(0);
    let what = format!("entry point `{}` of pass `{label}`", fragment.name);
    let need = Need { limit: "max_color_attachments", unit: "locations", cure: "" };
    need.require(&what, count.into(), context.limits().max_color_attachments.into())?;
    let at = |location| fragment.outputs.iter().find(|output| output.location == location).cloned();
    Ok((0..count).map(at).collect())
}

fn nearest() -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: targets::DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Greater),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}
