//! The GLB container (glTF 2.0, chapter 4). Done by hand: the gltf crate panics on chunks that lie about their length.

use super::LoadError;

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// The JSON text and the binary chunk of a GLB file; all of any other file is taken to be JSON.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), LoadError> {
    if !bytes.starts_with(MAGIC) {
        return Ok((bytes, None));
    }
    if word(bytes, 4)? != 2 {
        return Err(LoadError::Container("only version 2 is supported"));
    }
    let length = word(bytes, 8)? as usize;
    let bytes = bytes.get(..length).ok_or(LoadError::Container("it is shorter than its header says"))?;
    let (kind, json, rest) = chunk(bytes.get(12..).ok_or(LoadError::Container("the header's length is too small"))?)?;
    if kind != JSON {
        return Err(LoadError::Container("the first chunk is not JSON"));
    }
    if rest.is_empty() {
        return Ok((json, None));
    }
    let (kind, data, _) = chunk(rest)?;
    Ok((json, (kind == BIN).then_some(data)))
}

/// (type, data, what follows)
fn chunk(bytes: &[u8]) -> Result<(u32, &[u8], &[u8]), LoadError> {
    let (length, kind) = (word(bytes, 0)? as usize, word(bytes, 4)?);
    let (data, rest) = bytes[8..].split_at_checked(length).ok_or(LoadError::Container("a chunk is longer than the file"))?;
    Ok((kind, data, rest))
}

fn word(bytes: &[u8], at: usize) -> Result<u32, LoadError> {
    let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok());
    word.map(u32::from_le_bytes).ok_or(LoadError::Container("it ends within a header"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(chunks: &[(u32, &[u8])]) -> Vec<u8> {
        let mut body = Vec::new();
        for (kind, data) in chunks {
            body.extend((data.len() as u32).to_le_bytes());
            body.extend(kind.to_le_bytes());
            body.extend(*data);
        }
        let mut file = [MAGIC, &2_u32.to_le_bytes(), &(body.len() as u32 + 12).to_le_bytes()].concat();
        file.extend(body);
        file
    }

    #[test]
    fn chunks_come_apart() {
        let file = glb(&[(JSON, b"{}  "), (BIN, b"1234"), (7, b"more")]);
        assert_eq!(split(&file).unwrap(), (&b"{}  "[..], Some(&b"1234"[..])));
        assert_eq!(split(&glb(&[(JSON, b"{}")])).unwrap(), (&b"{}"[..], None));
        assert_eq!(split(b"{}").unwrap(), (&b"{}"[..], None));
    }

    #[test]
    fn every_truncation_is_an_error() {
        let file = glb(&[(JSON, b"{}  "), (BIN, b"1234")]);
        for length in 4..file.len() {
            assert!(matches!(split(&file[..length]), Err(LoadError::Container(_))), "{length}");
        }
        for length in 0..12_u32 {
            let mut lying = file.clone();
            lying[8..12].copy_from_slice(&length.to_le_bytes());
            assert!(matches!(split(&lying), Err(LoadError::Container(_))), "{length}");
        }
    }
}
