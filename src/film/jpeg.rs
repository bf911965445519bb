//! How strongly a JPEG file is compressed.
//!
//! In: a file. Out: its tables of luma and of chroma: the first two, as programs write them, or the only one for both.

/// How a file is coded (ITU-T T.81).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jpeg {
    /// The steps of luma.
    pub luma: Table,
    /// The steps of chroma.
    pub chroma: Table,
}

/// A table of steps, to whose multiples a block's coefficients are rounded; the first is that of its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// The square of the first step.
    pub first: f64,
    /// The mean of the squares.
    pub mean: f64,
}

impl Jpeg {
    /// How a file is coded, if it is a JPEG.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes.strip_prefix(b"\xff\xd8")?;
        let mut tables = [None; 4];
        loop {
            let [0xff, marker, high, low, ..] = *rest else {
                return None;
            };
            if marker == 0xff {
                rest = &rest[1..];
                continue;
            }
            let length = usize::from(u16::from_be_bytes([high, low]));
            let segment = rest.get(4..2 + length)?;
            match marker {
                0xdb => read_tables(segment, &mut tables)?,
                // What follows is the picture.
                0xda => {
                    let mut tables = tables.into_iter().flatten();
                    let luma = tables.next()?;
                    let chroma = tables.next().unwrap_or(luma);
                    return Some(Self { luma, chroma });
                }
                _ => {}
            }
            rest = rest.get(2 + length..)?;
        }
    }
}

fn read_tables(mut segment: &[u8], tables: &mut [Option<Table>; 4]) -> Option<()> {
    while let Some((&head, rest)) = segment.split_first() {
        let size = if head >> 4 == 0 { 1 } else { 2 };
        let steps = rest.get(..64 * size)?.chunks_exact(size);
        let squares = steps.map(|step| {
            let step = step
                .iter()
                .fold(0, |sum, byte| 256 * sum + u32::from(*byte));
            f64::from(step) * f64::from(step)
        });
        let squares: Vec<f64> = squares.collect();
        *tables.get_mut(usize::from(head & 15))? = Some(Table {
            first: squares[0],
            mean: squares.iter().sum::<f64>() / 64.0,
        });
        segment = &rest[64 * size..];
    }
    Some(())
}
