"""PCG64 (XSL-RR 128/64, O'Neill 2014) and SplitMix64 in Python's integers: the first outputs that the tests of
`noise/seed.rs` expect. Run with any Python 3; it prints code and output."""

M64, M128 = 2**64 - 1, 2**128 - 1
MULTIPLIER = 47026247687942121848144207491837523525


def splitmix(word):
    word = (word + 0x9E3779B97F4A7C15) & M64
    word = ((word ^ word >> 30) * 0xBF58476D1CE4E5B9) & M64
    word = ((word ^ word >> 27) * 0x94D049BB133111EB) & M64
    return word ^ word >> 31


def outputs(state, stream):
    increment = (stream << 1 | 1) & M128
    state = ((state + increment) * MULTIPLIER + increment) & M128
    while True:
        state = (state * MULTIPLIER + increment) & M128
        folded, turn = (state >> 64 ^ state) & M64, state >> 122
        yield (folded >> turn | folded << (64 - turn)) & M64


def stream_of(seed, run, code):
    digest = 0
    for word in (seed, run, code):
        digest = splitmix((digest + word) & M64)
    high = splitmix(digest)
    return outputs(high << 64 | splitmix(high), run << 8 | code)


for code in (0, 5, 6):
    print(code, hex(next(stream_of(42, 7, code))))
