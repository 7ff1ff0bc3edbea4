/*
 * starts_by_distance.glsl: rays start above a surface by twice the distance at the hit, or by twice
 * some roundings (Keinert et al. 2014, 3.3: a dynamic epsilon).
 *
 * So they start nearer than by pixels, unless the hit is far off.  The distance may be a bound that
 * is too small; then the ray may begin on the wrong side.
 */
const float MIN_ROUNDINGS = 4.0;

float find_height(HitPoint hit, float evenness, float distance)
{
    return 2.0 * max(MIN_ROUNDINGS * hit.rounding, abs(distance));
}
