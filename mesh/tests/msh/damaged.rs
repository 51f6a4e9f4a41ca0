//! Damaged files never end the program, and cost no more memory than the file has.

use alewife_mesh::{Place, read_msh};

use super::{BOX_TEXT, PIPE_BINARY, SQUARE_TEXT, refusal};

/// Files of each kind that are damaged.
const DAMAGED: usize = 200;

/// Random numbers (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % end as u64).expect("it is below a length")
    }
}

/// Some bytes replaced, taken out or doubled, or the end cut off.
fn damage(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 => bytes.truncate(at + 1),
            1 => drop(bytes.remove(at)),
            2 => bytes.insert(at, b'9'),
            3 => bytes[at] = 0xff,
            4 => {
                let end = (at + 1 + random.below(40)).min(bytes.len());
                drop(bytes.drain(at..end));
            }
            _ => bytes[at] = u8::try_from(random.below(256)).expect("it is a byte"),
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

#[test]
fn damaged_files_are_refused_or_read() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut n_refused = 0;
    for _ in 0..DAMAGED {
        let planar = damage(SQUARE_TEXT, &mut random);
        n_refused += usize::from(read_msh::<2>(&planar, 1.0).is_err());
        for bytes in [BOX_TEXT, PIPE_BINARY] {
            let spatial = damage(bytes, &mut random);
            n_refused += usize::from(read_msh::<3>(&spatial, 1.0).is_err());
        }
    }
    assert!(n_refused > DAMAGED, "{n_refused}");
}

#[test]
fn every_file_that_is_cut_off_is_refused() {
    // The end of the last section matters, the line after it does not
    for end in 0..SQUARE_TEXT.len() - 1 {
        assert!(read_msh::<2>(&SQUARE_TEXT[..end], 1.0).is_err(), "{end}");
    }
    let error = refusal::<3>(&PIPE_BINARY[..PIPE_BINARY.len() / 2]);
    assert!(matches!(error.place, Place::Byte(_)), "{error}");
}
