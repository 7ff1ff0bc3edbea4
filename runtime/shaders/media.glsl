/*
 * media.glsl: what rays of paths know of the glass that they are inside of.
 *
 * MEDIA: components that may let light through are media (compiler/print/media.c).  The side and
 * the medium of a ray are one number of its path: the sign is that of the side, and the size is 1
 * and the number of the medium.  The side is 1 then, unless the camera is inside of a solid.
 */
// Codes of rays to a light have the row of results for its light behind them, times this.
const uint CODES_OF_RAYS = 65536u;

float code_of_ray(float side, uint medium) { return side * float(1u + medium); }

// The fraction of the code of a ray of direct light, which says how it goes on through glass.
// STRAIGHT: it shows what is behind the glass as if that were in front.  SCATTERED: a surface has
// sent it there, whose light of lights is known.  Others have not met glass.
const float STRAIGHT = 0.5, SCATTERED = 0.25;

// With PHOTONS: DULL: a surface has scattered the path to which photons come.  FOCUSED: and only smooth ones have
// since.
const float DULL = 0.125, FOCUSED = 0.1875;

float code_through(float code, float how) { return code + sign(code) * how; }

uint medium_of_code(float code) { return code == 0.0 ? 0u : uint(abs(code)) - 1u; }

#ifdef MEDIA
void enter_medium(float code) { krs_medium = medium_of_code(code); }
bool is_in_medium() { return krs_medium != 0u; }
#else
void enter_medium(float code) {}
bool is_in_medium() { return false; }
#endif
