//! Variable-length integers in a page, which the parser assumes to be terminated.

/// The maximum number of bytes of such an integer: the parser panics if there are more.
const LONGEST: usize = 10;

/// The error of an integer that is longer than permitted.
pub(super) struct Endless;

/// Walks through runs of `count` values of `bits` bits (the format's "RLE / bit-packing hybrid"), up to
/// the end of the values or of the `bytes`. The first run is examined even if there are no values, as in the parser.
pub(super) fn walk_runs(mut bytes: &[u8], bits: usize, mut count: usize) -> Result<(), Endless> {
    loop {
        let Some(head) = number(&mut bytes)? else { return Ok(()) };
        let run = usize::try_from(head >> 1).unwrap_or(usize::MAX);
        let (values, length) = match head {
            // Only padding follows.
            0 => return Ok(()),
            _ if head & 1 == 1 => (run.saturating_mul(8), run.saturating_mul(bits)),
            _ => (run, bits.div_ceil(8)),
        };
        count = count.saturating_sub(values);
        if count == 0 {
            return Ok(());
        }
        bytes = bytes.get(length..).unwrap_or_default();
    }
}

/// Walks through `count` integers as differences (the format's "delta binary packed"), up to the end of the
/// integers or of the `bytes`.
pub(super) fn walk_differences(mut bytes: &[u8], count: usize) -> Result<(), Endless> {
    let mut head = [0; 4];
    for part in &mut head {
        let Some(read) = number(&mut bytes)? else { return Ok(()) };
        *part = usize::try_from(read).unwrap_or(usize::MAX);
    }
    let [block, parts, said, _first] = head;
    let Some(values) = block.checked_div(parts) else { return Ok(()) };
    let mut left = count.min(said).saturating_sub(1);
    while left > 0 {
        let Some(_least) = number(&mut bytes)? else { return Ok(()) };
        let Some((widths, rest)) = bytes.split_at_checked(parts) else { return Ok(()) };
        bytes = rest;
        for &bits in widths {
            if left == 0 {
                break;
            }
            let length = values.saturating_mul(bits.into()) / 8;
            bytes = bytes.get(length..).unwrap_or_default();
            left = left.saturating_sub(values);
        }
    }
    Ok(())
}

/// The integer at the beginning of `bytes`, seven bits per byte; `None` if they end within it.
pub(super) fn number(bytes: &mut &[u8]) -> Result<Option<u64>, Endless> {
    let mut read = 0;
    for (place, byte) in bytes.iter().enumerate() {
        if place == LONGEST {
            return Err(Endless);
        }
        read |= u64::from(byte & 0x7f) << (7 * place);
        if byte & 0x80 == 0 {
            *bytes = &bytes[place + 1..];
            return Ok(Some(read));
        }
    }
    Ok(None)
}
