//! Animation channels of nodes.

use super::{LoadError, Loader, MAX_KEYS, accessor::Wanted, limits::spend, nodes::NodeMap};
use crate::{Channel, Interpolation, Track, unit};
use glam::{Quat, Vec3};
use gltf::json::{
    accessor::Type,
    animation::{self, Animation, Property},
    validation::Checked,
};
use std::collections::HashSet;

impl Loader<'_> {
    /// All animations play at once. Where two of them move the same property of a node, the first one has it.
    pub(super) fn read_animations(&mut self, nodes: &NodeMap) -> Result<(), LoadError> {
        let animations = self.document.as_json().animations.clone();
        let mut taken: HashSet<(usize, &str)> = HashSet::new();
        let (mut doubled, mut morphs) = (0, 0);
        for (index, animation) in animations.iter().enumerate() {
            for (number, channel) in animation.channels.iter().enumerate() {
                let pointer = format!("/animations/{index}/channels/{number}");
                let node = channel.target.node.value();
                let count = self.document.as_json().nodes.len();
                if node >= count {
                    return Err(LoadError::Index { pointer: format!("{pointer}/target/node"), index: node as u64, count });
                }
                let Some((property, name)) = property(channel, &pointer)? else {
                    morphs += 1;
                    continue;
                };
                let read = self.read_channel(animation, channel, property, &pointer)?;
                // Nodes outside the shown scene are checked like the others, and then forgotten.
                let Some(&node_in_scene) = nodes.get(&node) else { continue };
                if taken.insert((node, name)) {
                    self.scene.animation.push(Channel { node: node_in_scene, ..read });
                } else {
                    doubled += 1;
                }
            }
        }
        if doubled > 0 {
            self.warn(format!("{doubled} animation channels left out: an earlier animation moves the same property"));
        }
        if morphs > 0 {
            self.warn(format!("{morphs} animation channels of morph target weights left out"));
        }
        Ok(())
    }

    fn read_channel(
        &self,
        animation: &Animation,
        channel: &animation::Channel,
        property: Property,
        pointer: &str,
    ) -> Result<Channel, LoadError> {
        let samplers = &animation.samplers;
        let index = channel.sampler.value();
        let missing = || LoadError::Index { pointer: format!("{pointer}/sampler"), index: index as u64, count: samplers.len() };
        let sampler = samplers.get(index).ok_or_else(missing)?;
        let interpolation = match sampler.interpolation {
            Checked::Valid(animation::Interpolation::Linear) => Interpolation::Linear,
            Checked::Valid(animation::Interpolation::Step) => Interpolation::Step,
            Checked::Valid(animation::Interpolation::CubicSpline) => Interpolation::CubicSpline,
            Checked::Invalid => return Err(LoadError::invalid(pointer, "unknown interpolation")),
        };
        let times = self.read_times(sampler.input.value(), pointer)?;
        let track = self.read_track(sampler.output.value(), property)?;
        let expected = times.len() * Channel::values_a_key(interpolation);
        if track.len() != expected {
            let why = format!("{} output values where {} keys need {expected}", track.len(), times.len());
            return Err(LoadError::invalid(pointer, why));
        }
        if let Track::Rotation(values) = &track {
            let values_a_key = Channel::values_a_key(interpolation);
            if values.iter().skip(values_a_key / 2).step_by(values_a_key).any(|&value| unit::rotation(value).is_none()) {
                return Err(LoadError::invalid(pointer, "a rotation has no length"));
            }
        }
        Ok(Channel { node: 0, track, times, interpolation })
    }

    fn read_times(&self, accessor: usize, pointer: &str) -> Result<Vec<f32>, LoadError> {
        let elements = self.elements(accessor, Wanted::floats(Type::Scalar))?;
        spend(&self.budget.keys, elements.count as u64, MAX_KEYS, "animation keys")?;
        let times: Vec<f32> = elements.all::<1>()?.into_iter().flatten().collect();
        if times.windows(2).all(|pair| pair[0] < pair[1]) {
            Ok(times)
        } else {
            Err(LoadError::invalid(format!("/accessors/{accessor}"), format!("key times of {pointer} must increase strictly")))
        }
    }

    fn read_track(&self, accessor: usize, property: Property) -> Result<Track, LoadError> {
        let wanted = if property == Property::Rotation { Wanted::signed_unit(Type::Vec4) } else { Wanted::floats(Type::Vec3) };
        let elements = self.elements(accessor, wanted)?;
        spend(&self.budget.keys, elements.count as u64, MAX_KEYS, "animation keys")?;
        if property == Property::Rotation {
            return Ok(Track::Rotation(elements.all()?.into_iter().map(Quat::from_array).collect()));
        }
        let values = elements.all()?.into_iter().map(Vec3::from_array).collect();
        Ok(if property == Property::Scale { Track::Scale(values) } else { Track::Translation(values) })
    }
}

/// The property with its name; `None` for weights.
fn property(channel: &animation::Channel, pointer: &str) -> Result<Option<(Property, &'static str)>, LoadError> {
    match channel.target.path {
        Checked::Valid(property @ Property::Translation) => Ok(Some((property, "translation"))),
        Checked::Valid(property @ Property::Rotation) => Ok(Some((property, "rotation"))),
        Checked::Valid(property @ Property::Scale) => Ok(Some((property, "scale"))),
        Checked::Valid(Property::MorphTargetWeights) => Ok(None),
        Checked::Invalid => Err(LoadError::invalid(format!("{pointer}/target/path"), "unknown property")),
    }
}
