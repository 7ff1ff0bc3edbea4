/*
 * march.glsl: the state of a ray or beam that is marched, and how it begins; trace.comp describes the march, and
 * march_step.glsl has its step.  Shaders of pages march by it as well (web/picture).
 */
const uint PLAIN = 1u, RELAXED = 2u, AUTOMATIC = 3u; // TRACE: as KrsTrace

// The longest interval that may stay unverified: in permitted errors, and in pixels at most.  Twigs
// of a tenth of a pixel lose less than 1 % by it (tests/oracle/coverage.c).
const float TOLERANCE = 0.05;
const float MAX_TOLERANCE = 0.0125;
// RELAXATION: the relaxed step, relative to the distance.  LEARNING: how fast the mean slope
// follows the last one.
const float RELAXATION = 1.2;
const float LEARNING = 0.3;
// The automatic method.  OVERSHOOT: a step that crosses an expected surface, relative to its
// distance.  SHALLOW: a chord is trusted if the depth at its end is below this part of the
// clearance at its start.
const float OVERSHOOT = 1.05;
const float SHALLOW = 0.25;
// Solids that touch are one.  From inside they count as larger, by what rounding may leave open at
// the seam between two.
const float SEAM = 4.0; // roundings
// A beam ends where its ball is hardly wider than the tile.
const float BEAM_MARGIN = 1.05;

// The state of a ray that is marched; in the queue two rows of four numbers.
struct RayMarch {
    uint  index;     // of its pixel or beam in `ends`
    float t;         // nothing is hit up to here
    float clearance; // nothing is hit for this length behind t either
    float step;      // from t to the next sample of the distance
    float slope;     // of the clearance along the ray: a running mean
    float side;      // as in RayEnd; 0: unknown
    uint  steps;
    uint  state;
};

RayMarch march;
vec3  origin, direction;
float end;
#ifdef STEPS
vec2  sampled;                 // krs_steps at the next position
float march_radius;            // of the ball at t: of what rays know no roots of
#endif
float plane_t;                 // with PLANES: where a ray meets a plane; INFINITE: nowhere
float pixel_base, pixel_slope; // a pixel is as wide as base + slope t
vec2  width;                   // of a beam, likewise; 0 for a ray; less: solids count as larger
float shrinking;               // of the clearance, since the beam gets wider: 1 / (1 + slope)
bool  ends_at_walls;           // all solids end at `end`
float rounding;                // magnitude of coordinates at t = 0
float tolerance_in_pixels;     // length that may stay unverified, in pixels
#ifdef TOUCHES
vec3  aside;                   // from the start to where the first distance is taken, then 0
float cosine;                  // of the angle between that and the ray
#endif

float tolerance_at(float t)
{
    return tolerance_in_pixels * width_at(t, pixel_base + pixel_slope * t) + ROUNDING * (rounding + t);
}

// Aims the ray, or the beam's axis, through a point of the picture.
void aim(vec2 image_point)
{
    find_ray(image_point, origin, direction, pixel_base, pixel_slope);
    rounding = largest(origin);
}

// Tells whether a ray begins just above a surface and knows its normal.  If rounding puts it behind
// the surface, that is no hit for a while: for LEAVING roundings, or a part of a pixel.  What may
// stay unverified, also behind an expected surface (OVERSHOOT), are parts of its length.  So a ray
// that creeps along a surface gets away from it.
const float LEAVING = 192.0, LEAVING_IN_PIXELS = 0.03125, UNVERIFIED = 1.0 / 2048.0,
            PERMITTED = 1.0 / 32.0;
bool leaves_surfaces()
{
#ifdef FOLLOWS_PATHS
    return are_of_paths() && snaps();
#else
    return false;
#endif
}

vec2 inside_width() { return -SEAM * ROUNDING * vec2(rounding, 1.0); }

// Begins the march of a ray or beam at `start`, before which nothing is hit.
void begin_march(uint index, float start, bool is_ray)
{
    march.index = index;
    march.t = start;
    march.clearance = march.step = 0.0;
#ifdef STEPS
    march_radius = 0.0;
#endif
    march.slope = -1.0 / (1.0 - LEARNING); // -1 after the first step
    // The side is not known before the first distance, unless empty space lies behind the ray.
    march.side = march.t > 0.0 || !is_ray ? 1.0 : 0.0;
    march.steps = 0u;
    march.state = march.t <= end ? STATE_MARCHING : STATE_MISS;
#ifdef PROBE
    // Beams end where the tile no longer fits into the ball.
    march.step = start > 0.0 ? 3.0 * (pixel_base + pixel_slope * start)
                             : 0.05 * (end - start);
    march.step = max(march.step, ROUNDING * (rounding + start));
#endif
}

#if defined(ALONG) || defined(STEPS)
// Returns the length back to the last position, and some roundings more.  Else a point just before
// a surface without thickness could count as behind it at this step.
float distance_behind()
{
    float margin = 2.0 * ROUNDING * (rounding + march.t + march.step);
    return march.step > 0.0 ? march.step + margin : 0.0;
}
#endif
