/*
 * identity.glsl: numbers of copies by hashing: integers only, so that every device and
 * graph/op_values.c agree to the bit.
 */

uint krs_scramble(uint x)
{
    uint once = (x ^ (x >> 16)) * 0x7feb352du;
    uint twice = (once ^ (once >> 15)) * 0x846ca68bu;
    return twice ^ (twice >> 16);
}

uint krs_hash_id(uint a, bool b)
{
    return krs_scramble(a + (b ? 0x9e3779b9u : 0x7f4a7c15u));
}

uint krs_join_id(uint a, uint b) { return krs_scramble(krs_scramble(a) + b); }

float krs_id_unit(uint a) { return float(krs_scramble(a) >> 8) * (1.0 / 16777216.0); }
