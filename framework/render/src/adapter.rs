//! Which adapters there are, and which one to take.

use crate::{Error, limits};
use serde::Serialize;
use std::collections::BTreeMap;

/// What can be said about an adapter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct AdapterReport {
    /// E.g. `llvmpipe (LLVM 15.0.6, 256 bits)`.
    pub name: String,
    /// `vulkan`, `metal`, `dx12` or `noop`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    pub kind: &'static str,
    /// Driver and its version.
    pub driver: String,
    /// Passes can be timed on the device.
    pub timestamps: bool,
    /// The limits that a graph can run into, in the units of wgpu.
    pub limits: BTreeMap<&'static str, u64>,
}

impl AdapterReport {
    pub(crate) fn new(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        AdapterReport {
            name: info.name,
            backend: info.backend.to_string(),
            kind: kind(info.device_type),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY),
            limits: limits::named(&adapter.limits()),
        }
    }
}

/// Every adapter of this machine, best first. `WGPU_BACKEND` narrows the choice.
pub fn adapters() -> Vec<AdapterReport> {
    enumerate().iter().map(AdapterReport::new).collect()
}

/// The best adapter whose name or backend contains `wanted`, in any case of letters.
pub(crate) fn choose(wanted: Option<&str>) -> Result<wgpu::Adapter, Error> {
    let mut all = enumerate();
    if all.is_empty() {
        return Err(Error::NoAdapter);
    }
    let Some(wanted) = wanted else { return Ok(all.remove(0)) };
    let sought = wanted.to_lowercase();
    let fits = |adapter: &wgpu::Adapter| {
        let report = AdapterReport::new(adapter);
        report.name.to_lowercase().contains(&sought) || report.backend.contains(&sought)
    };
    match all.iter().position(fits) {
        Some(index) => Ok(all.remove(index)),
        None => Err(Error::NoSuchAdapter { wanted: wanted.to_owned(), found: all.iter().map(|adapter| adapter.get_info().name).collect() }),
    }
}

/// An adapter that takes every command and executes none.
pub(crate) fn noop(limits: wgpu::Limits) -> Result<wgpu::Adapter, Error> {
    let options =
        wgpu::NoopBackendOptions { enable: true, limits: Some(limits), features: Some(wgpu::Features::empty()), ..Default::default() };
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions { noop: options, ..Default::default() },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::NOOP)).pop().ok_or(Error::NoAdapter)
}

fn enumerate() -> Vec<wgpu::Adapter> {
    let backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::all());
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        flags: wgpu::InstanceFlags::empty().with_env(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let mut all = pollster::block_on(instance.enumerate_adapters(backends));
    all.retain(can_compute);
    all.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    all
}

fn can_compute(adapter: &wgpu::Adapter) -> bool {
    adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS)
}

fn rank(kind: wgpu::DeviceType) -> u32 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    }
}

fn kind(kind: wgpu::DeviceType) -> &'static str {
    match kind {
        wgpu::DeviceType::DiscreteGpu => "discrete",
        wgpu::DeviceType::IntegratedGpu => "integrated",
        wgpu::DeviceType::VirtualGpu => "virtual",
        wgpu::DeviceType::Cpu => "cpu",
        wgpu::DeviceType::Other => "other",
    }
}
