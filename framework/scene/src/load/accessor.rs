//! Typed elements out of buffers, with every range checked before a byte is read.

use super::{
    LoadError, Loader, MAX_ZEROS,
    limits::{Budget, spend},
};
use gltf::json::{
    Index,
    accessor::{ComponentType, Type},
    buffer::View,
    validation::Checked,
};
use std::{borrow::Cow, collections::BTreeMap};

/// An accessor ready to be read: every element is known to lie inside its bytes.
pub(super) struct Elements<'a> {
    pointer: String,
    bytes: Option<Strided<'a>>,
    /// Sparse substitutes: element → place in its bytes.
    substitutes: Option<(BTreeMap<u32, usize>, Strided<'a>)>,
    component: ComponentType,
    normalized: bool,
    /// How many.
    pub count: usize,
}

#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl Strided<'_> {
    fn element(&self, index: usize, size: usize) -> &[u8] {
        let start = index * self.stride;
        &self.bytes[start..start + size]
    }
}

/// What an accessor must hold.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    shape: Type,
    integers: &'static [ComponentType],
    floats: bool,
}

const UNSIGNED: &[ComponentType] = &[ComponentType::U8, ComponentType::U16];
const SMALL: &[ComponentType] = &[ComponentType::I8, ComponentType::U8, ComponentType::I16, ComponentType::U16];
const INDICES: &[ComponentType] = &[ComponentType::U8, ComponentType::U16, ComponentType::U32];

impl Wanted {
    /// 32-bit floats.
    pub const fn floats(shape: Type) -> Self {
        Self { shape, integers: &[], floats: true }
    }

    /// Floats, or unsigned integers that stand for 0 to 1.
    pub const fn unit(shape: Type) -> Self {
        Self { shape, integers: UNSIGNED, floats: true }
    }

    /// Floats, or integers that stand for −1 to 1.
    pub const fn signed_unit(shape: Type) -> Self {
        Self { shape, integers: SMALL, floats: true }
    }

    /// Vertex indices.
    pub const INDEX: Self = Self { shape: Type::Scalar, integers: INDICES, floats: false };

    fn accepts(&self, shape: Type, component: ComponentType, normalized: bool) -> bool {
        let float = self.floats && component == ComponentType::F32;
        // Integers are either indices or stand for fractions.
        let integer = self.integers.contains(&component) && normalized == self.floats;
        shape == self.shape && (float || integer)
    }
}

impl Loader<'_> {
    /// Checks accessor `index` for a use.
    pub(super) fn elements(&self, index: usize, wanted: Wanted) -> Result<Elements<'_>, LoadError> {
        self.source().elements(index, wanted, &self.budget)
    }

    /// The bytes of a view, for images.
    pub(super) fn view_bytes(&self, view: Index<View>) -> Result<&[u8], LoadError> {
        self.source().view(view).map(|(_, bytes)| bytes)
    }

    fn source(&self) -> Source<'_> {
        Source { root: self.document.as_json(), buffers: &self.buffers }
    }
}

/// What accessors read from.
struct Source<'a> {
    root: &'a gltf::json::Root,
    buffers: &'a [Cow<'a, [u8]>],
}

impl<'a> Source<'a> {
    fn elements(&self, index: usize, wanted: Wanted, budget: &Budget) -> Result<Elements<'a>, LoadError> {
        let pointer = format!("/accessors/{index}");
        let count = self.root.accessors.len();
        let accessor = self.root.accessors.get(index).ok_or(LoadError::Index { pointer: pointer.clone(), index: index as u64, count })?;
        let (Checked::Valid(shape), Checked::Valid(component)) = (accessor.type_, accessor.component_type) else {
            return Err(LoadError::invalid(pointer, "unknown type"));
        };
        let component = component.0;
        if !wanted.accepts(shape, component, accessor.normalized) {
            let found = format!("{shape:?} of {}{component:?}", if accessor.normalized { "normalized " } else { "" });
            let floats = if wanted.floats { "floats or normalized integers as its use allows" } else { "unsigned integers" };
            return Err(LoadError::ElementType { pointer, expected: format!("{:?} of {floats}", wanted.shape), found });
        }
        let size = component.size() * shape.multiplicity();
        let elements = accessor.count.0;
        let bytes = match accessor.buffer_view {
            Some(view) => Some(self.strided(view, accessor.byte_offset.map_or(0, |offset| offset.0), elements, size, true, &pointer)?),
            None => {
                spend(&budget.zeros, elements, MAX_ZEROS, "elements of accessors without bytes")?;
                None
            }
        };
        let substitutes = match &accessor.sparse {
            None => None,
            Some(sparse) => {
                let pointer = format!("{pointer}/sparse");
                let values = self.strided(sparse.values.buffer_view, sparse.values.byte_offset.0, sparse.count.0, size, false, &pointer)?;
                Some((self.sparse_indices(sparse, elements, &pointer)?, values))
            }
        };
        Ok(Elements { pointer, bytes, substitutes, component, normalized: accessor.normalized, count: elements as usize })
    }

    /// `count` elements of `size` bytes from `offset` of a view.
    fn strided(
        &self,
        view: Index<View>,
        offset: u64,
        count: u64,
        size: usize,
        may_stride: bool,
        pointer: &str,
    ) -> Result<Strided<'a>, LoadError> {
        let (view, bytes) = self.view(view)?;
        let stride = view.byte_stride.map_or(size, |stride| stride.0);
        if stride < size || (!may_stride && stride != size) {
            return Err(LoadError::invalid(pointer, format!("a stride of {stride} bytes does not fit elements of {size}")));
        }
        let before_last = count.saturating_sub(1).saturating_mul(stride as u64);
        let needed = if count == 0 { offset } else { offset.saturating_add(before_last).saturating_add(size as u64) };
        let available = bytes.len() as u64;
        if needed > available {
            return Err(LoadError::Overrun { pointer: pointer.to_owned(), needed, available });
        }
        Ok(Strided { bytes: &bytes[offset as usize..], stride })
    }

    fn view(&self, index: Index<View>) -> Result<(&'a View, &'a [u8]), LoadError> {
        let (pointer, count) = (format!("/bufferViews/{}", index.value()), self.root.buffer_views.len());
        let missing = |index: usize, count| LoadError::Index { pointer: pointer.clone(), index: index as u64, count };
        let view = self.root.buffer_views.get(index.value()).ok_or_else(|| missing(index.value(), count))?;
        let buffer = view.buffer.value();
        let bytes = self.buffers.get(buffer).ok_or_else(|| missing(buffer, self.buffers.len()))?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let (needed, available) = (start.saturating_add(view.byte_length.0), bytes.len() as u64);
        if needed > available {
            return Err(LoadError::Overrun { pointer, needed, available });
        }
        Ok((view, &bytes[start as usize..needed as usize]))
    }

    fn sparse_indices(
        &self,
        sparse: &gltf::json::accessor::sparse::Sparse,
        elements: u64,
        pointer: &str,
    ) -> Result<BTreeMap<u32, usize>, LoadError> {
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(LoadError::invalid(format!("{pointer}/indices"), "unknown type"));
        };
        let size = component.0.size();
        let bytes = self.strided(sparse.indices.buffer_view, sparse.indices.byte_offset.0, sparse.count.0, size, false, pointer)?;
        let mut places = BTreeMap::new();
        for place in 0..sparse.count.0 as usize {
            let index = unsigned(bytes.element(place, size), component.0);
            if u64::from(index) >= elements {
                return Err(LoadError::Index { pointer: format!("{pointer}/indices"), index: index.into(), count: elements as usize });
            }
            if places.last_key_value().is_some_and(|(&last, _)| last >= index) {
                return Err(LoadError::invalid(format!("{pointer}/indices"), "indices must increase strictly"));
            }
            places.insert(index, place);
        }
        Ok(places)
    }
}

impl Elements<'_> {
    /// An element as floats.
    pub(super) fn floats<const N: usize>(&self, index: usize) -> Result<[f32; N], LoadError> {
        let Some(bytes) = self.raw(index, N) else { return Ok([0.0; N]) };
        let size = self.component.size();
        let values = std::array::from_fn(|i| fraction(&bytes[i * size..(i + 1) * size], self.component));
        if values.iter().all(|value| value.is_finite()) {
            Ok(values)
        } else {
            Err(LoadError::NotFinite { pointer: format!("{}: element {index}", self.pointer) })
        }
    }

    /// All elements as floats.
    pub(super) fn all<const N: usize>(&self) -> Result<Vec<[f32; N]>, LoadError> {
        (0..self.count).map(|index| self.floats(index)).collect()
    }

    /// All elements as indices below `limit`.
    pub(super) fn indices(&self, limit: usize) -> Result<Vec<u32>, LoadError> {
        debug_assert!(!self.normalized, "asked for as `Wanted::INDEX`");
        let index = |element: usize| {
            let index = self.raw(element, 1).map_or(0, |bytes| unsigned(bytes, self.component));
            let pointer = || format!("{}: element {element}", self.pointer);
            if (index as usize) < limit {
                Ok(index)
            } else {
                Err(LoadError::Index { pointer: pointer(), index: index.into(), count: limit })
            }
        };
        (0..self.count).map(index).collect()
    }

    fn raw(&self, index: usize, components: usize) -> Option<&[u8]> {
        let size = self.component.size() * components;
        let substitute = self.substitutes.as_ref().and_then(|(places, bytes)| Some(bytes.element(*places.get(&(index as u32))?, size)));
        substitute.or_else(|| Some(self.bytes.as_ref()?.element(index, size)))
    }
}

fn unsigned(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 => bytes[0].into(),
        ComponentType::U16 => u16::from_le_bytes([bytes[0], bytes[1]]).into(),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}

/// glTF 2.0, 3.11: integers stand for fractions.
fn fraction(bytes: &[u8], component: ComponentType) -> f32 {
    let short = || [bytes[0], bytes[1]];
    match component {
        ComponentType::I8 => (f32::from(bytes[0] as i8) / 127.0).max(-1.0),
        ComponentType::U8 => f32::from(bytes[0]) / 255.0,
        ComponentType::I16 => (f32::from(i16::from_le_bytes(short())) / 32767.0).max(-1.0),
        ComponentType::U16 => f32::from(u16::from_le_bytes(short())) / 65535.0,
        ComponentType::U32 | ComponentType::F32 => f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}
