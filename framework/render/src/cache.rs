//! Shader modules and pipelines by content, so that renderers share them.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

/// A pipeline with the layouts that its bind groups need.
#[derive(Debug)]
pub(crate) struct Pipeline<P> {
    pub pipeline: P,
    /// By group; `None` where the entry points reach nothing of it.
    pub layouts: Vec<Option<wgpu::BindGroupLayout>>,
}

/// How many pipelines that nobody uses are kept for whoever comes back to them.
const IDLE: usize = 256;

#[derive(Debug, Default)]
pub(crate) struct PipelineCache {
    modules: Mutex<HashMap<blake3::Hash, wgpu::ShaderModule>>,
    pub compute: Kept<wgpu::ComputePipeline>,
    pub render: Kept<wgpu::RenderPipeline>,
}

impl PipelineCache {
    /// The module with this text, made by `make` when it is the first.
    pub fn module<E>(&self, text: &str, make: impl FnOnce() -> Result<wgpu::ShaderModule, E>) -> Result<wgpu::ShaderModule, E> {
        let key = blake3::hash(text.as_bytes());
        let mut modules = self.modules.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(module) = modules.get(&key) {
            return Ok(module.clone());
        }
        let module = make()?;
        modules.insert(key, module.clone());
        Ok(module)
    }
}

/// Pipelines of one kind.
#[derive(Debug)]
pub(crate) struct Kept<P>(Mutex<HashMap<blake3::Hash, Entry<P>>>);

impl<P> Default for Kept<P> {
    fn default() -> Self {
        Kept(Mutex::default())
    }
}

#[derive(Debug)]
struct Entry<P> {
    pipeline: Arc<Pipeline<P>>,
    used: u64,
}

impl<P> Kept<P> {
    /// The pipeline of this specialisation, made by `make` when it is the first.
    pub fn pipeline<E>(&self, key: blake3::Hash, make: impl FnOnce() -> Result<Pipeline<P>, E>) -> Result<Arc<Pipeline<P>>, E> {
        let mut pipelines = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let now = pipelines.values().map(|entry| entry.used).max().unwrap_or(0) + 1;
        if let Some(entry) = pipelines.get_mut(&key) {
            entry.used = now;
            return Ok(entry.pipeline.clone());
        }
        let pipeline = Arc::new(make()?);
        pipelines.insert(key, Entry { pipeline: pipeline.clone(), used: now });
        forget_oldest(&mut pipelines);
        Ok(pipeline)
    }
}

fn forget_oldest<P>(pipelines: &mut HashMap<blake3::Hash, Entry<P>>) {
    let idle = pipelines.iter().filter(|(_, entry)| Arc::strong_count(&entry.pipeline) == 1);
    let mut idle: Vec<_> = idle.map(|(key, entry)| (entry.used, *key)).collect();
    idle.sort_unstable_by_key(|(used, _)| std::cmp::Reverse(*used));
    for (_, key) in idle.into_iter().skip(IDLE) {
        pipelines.remove(&key);
    }
}

/// Of a specialisation. Layouts and formats follow from the text and the entry points, so they need no part in it. Lengths keep neighbouring
/// parts apart.
pub(crate) fn key(text: &str, entries: &[&str], constants: &[(String, f64)]) -> blake3::Hash {
    let mut sorted: Vec<_> = constants.iter().collect();
    sorted.sort_by(|a, b| a.0.cmp(&b.0));
    let mut hasher = blake3::Hasher::new();
    let names = sorted.iter().map(|(name, _)| name.as_str());
    for part in [text].into_iter().chain(entries.iter().copied()).chain(names) {
        hasher.update(&(part.len() as u64).to_le_bytes()).update(part.as_bytes());
    }
    for (_, value) in sorted {
        hasher.update(&value.to_bits().to_le_bytes());
    }
    hasher.finalize()
}

#[cfg(test)]
mod tests {
    use super::key;

    #[test]
    fn keys_tell_specialisations_apart_and_ignore_the_order_of_constants() {
        let constant = |name: &str, value| (name.to_owned(), value);
        let ab = [constant("a", 1.0), constant("b", 2.0)];
        let ba = [constant("b", 2.0), constant("a", 1.0)];
        assert_eq!(key("t", &["e"], &ab), key("t", &["e"], &ba));
        let others = [
            key("te", &[""], &[]),
            key("t", &["e"], &[]),
            key("", &["te"], &[]),
            key("t", &["", "e"], &[]),
            key("t", &["e"], &ab[..1]),
            key("t", &["e"], &[constant("a", 2.0)]),
        ];
        for (index, one) in others.iter().enumerate() {
            assert!(others[..index].iter().all(|other| other != one), "{index}");
        }
    }
}
