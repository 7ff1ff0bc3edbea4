/*
 * exact.c: quadratics, slabs, and a picture rod by rod.
 *
 * A line's part in a convex solid is one interval, so intersections are intersections of
 * intervals, and a capsule, which is a cylinder and two balls, has the interval around theirs.
 */
#include "tests/oracle/exact.h"

#include <stdlib.h>

static const Chord NONE = {HUGE_VAL, -HUGE_VAL};
static const Chord ALL  = {-HUGE_VAL, HUGE_VAL};

/* Returns where a + b t is at most `limit`. */
static Chord chord_below(double a, double b, double limit)
{
    if (b == 0)
        return a <= limit ? ALL : NONE;
    double t = (limit - a) / b;
    return b > 0 ? (Chord){-HUGE_VAL, t} : (Chord){t, HUGE_VAL};
}

/* Returns the interval around two. */
static Chord chord_join(Chord a, Chord b)
{
    if (chord_is_empty(a))
        return b;
    return chord_is_empty(b) ? a : (Chord){fmin(a.enter, b.enter), fmax(a.leave, b.leave)};
}

static Chord chord_moved(Chord chord, double by)
{
    return (Chord){chord.enter + by, chord.leave + by};
}

/* Returns the parameter at which the line is nearest to a point: from there on, no large numbers
   cancel. */
static double line_nearest(Line line, Vec point)
{
    return vec_dot(vec_sub(point, line.origin), line.direction);
}

Chord chord_of_ball(Line line, Vec centre, double radius)
{
    double middle = line_nearest(line, centre);
    Vec    apart  = vec_sub(line_at(line, middle), centre);
    double square = radius * radius - vec_dot(apart, apart);
    if (square < 0)
        return NONE;
    return (Chord){middle - sqrt(square), middle + sqrt(square)};
}

Chord chord_of_half(Line line, Half half)
{
    return chord_below(vec_dot(half.normal, line.origin), vec_dot(half.normal, line.direction),
                       half.offset);
}

Chord chord_of_box(Line line, Vec low, Vec high)
{
    Vec   o = line.origin, d = line.direction;
    Chord x = chord_meet(chord_below(o.x, d.x, high.x), chord_below(-o.x, -d.x, -low.x));
    Chord y = chord_meet(chord_below(o.y, d.y, high.y), chord_below(-o.y, -d.y, -low.y));
    Chord z = chord_meet(chord_below(o.z, d.z, high.z), chord_below(-o.z, -d.z, -low.z));
    return chord_meet(x, chord_meet(y, z));
}

/* Returns the tube about an endless axis through `point`: a quadratic in the plane across it. */
static Chord chord_of_tube(Line line, Vec point, Vec axis, double radius)
{
    Vec o = vec_sub(line.origin, point), d = line.direction;
    o        = vec_sub(o, vec_scale(vec_dot(o, axis), axis));
    d        = vec_sub(d, vec_scale(vec_dot(d, axis), axis));
    double a = vec_dot(d, d), b = vec_dot(o, d), c = vec_dot(o, o) - radius * radius;
    if (a < 1e-30)
        return c <= 0 ? ALL : NONE;
    double square = b * b - a * c;
    if (square < 0)
        return NONE;
    return (Chord){(-b - sqrt(square)) / a, (-b + sqrt(square)) / a};
}

Chord chord_of_capsule(Line line, Vec from, Vec to, double radius)
{
    Vec    axis   = vec_unit(vec_sub(to, from));
    double near   = line_nearest(line, from);
    Line   moved  = {line_at(line, near), line.direction};
    Half   before = {axis, vec_dot(axis, to)}, behind = {vec_scale(-1, axis), -vec_dot(axis, from)};
    Chord  tube = chord_of_tube(moved, from, axis, radius);
    tube = chord_meet(tube, chord_meet(chord_of_half(moved, before), chord_of_half(moved, behind)));
    Chord ends = chord_join(chord_of_ball(moved, from, radius), chord_of_ball(moved, to, radius));
    return chord_moved(chord_join(tube, ends), near);
}

Chord chord_of_rod(Line line, const Rod *rod)
{
    Chord chord = chord_of_capsule(line, rod->from, rod->to, rod->radius);
    for (int i = 0; i < rod->cut_count && !chord_is_empty(chord); i++)
        chord = chord_meet(chord, chord_of_half(line, rod->cuts[i]));
    return chord;
}

/* The isometry's turn undone. */
static Vec turn_back(const Isometry *map, Vec v)
{
    Vec sum = vec_add(vec_scale(v.x, map->rows[0]), vec_scale(v.y, map->rows[1]));
    return vec_add(sum, vec_scale(v.z, map->rows[2]));
}

Rod rod_of_copy(const Copy *copy)
{
    const Isometry *pull = &copy->pull;
    Rod             rod  = {
                     .from      = turn_back(pull, vec_sub(copy->body->from, pull->shift)),
                     .to        = turn_back(pull, vec_sub(copy->body->to, pull->shift)),
                     .radius    = copy->body->radius,
                     .cut_count = copy->cut_count,
    };
    for (int i = 0; i < rod.cut_count; i++) {
        Half cut    = copy->cuts[i];
        rod.cuts[i] = (Half){turn_back(pull, cut.normal),
                             cut.offset - vec_dot(cut.normal, pull->shift)};
    }
    return rod;
}

Lens lens_make(Vec eye, Vec target, double half, bool parallel, int width, int height)
{
    Vec forward = vec_unit(vec_sub(target, eye));
    Vec right   = vec_unit(vec_cross(forward, vec(0, 1, 0)));
    return (Lens){eye, right, vec_cross(right, forward), forward, half, parallel, width, height};
}

Line lens_ray(const Lens *lens, double x, double y)
{
    double across  = (2 * x - lens->width) / lens->height * lens->half;
    double above   = (1 - 2 * y / lens->height) * lens->half;
    Vec    lateral = vec_add(vec_scale(across, lens->right), vec_scale(above, lens->up));
    if (lens->parallel)
        return (Line){vec_add(lens->eye, lateral), lens->forward};
    return (Line){lens->eye, vec_unit(vec_add(lens->forward, lateral))};
}

double lens_pixel(const Lens *lens, double depth)
{
    double pixel = 2 * lens->half / lens->height;
    return lens->parallel ? pixel : pixel * depth;
}

/* Where a point is seen, in pixels; `z` is its depth. */
static Vec lens_place(const Lens *lens, Vec point)
{
    Vec    apart = vec_sub(point, lens->eye);
    double depth = vec_dot(apart, lens->forward), pixel = lens_pixel(lens, depth);
    return vec(lens->width / 2.0 + vec_dot(apart, lens->right) / pixel,
               lens->height / 2.0 - vec_dot(apart, lens->up) / pixel, depth);
}

/* The first pixel of a row of `count` whose place, i + offset, is not below `low`. */
static int pixel_from(double low, double offset, int count)
{
    return (int)fmax(0, fmin(ceil(low - offset), count));
}

/* What of a row at height y is, about, within `reach` of the segment; false where nothing is. */
static bool row_part(Vec from, Vec to, double y, double reach, double *left, double *right)
{
    double low = 0, high = 1, rise = to.y - from.y;
    if (rise != 0) {
        double a = (y - reach - from.y) / rise, b = (y + reach - from.y) / rise;
        low  = fmax(0, fmin(a, b));
        high = fmin(1, fmax(a, b));
    }
    double a = from.x + low * (to.x - from.x), b = from.x + high * (to.x - from.x);
    *left  = fmin(a, b) - reach;
    *right = fmax(a, b) + reach;
    return low <= high;
}

/* Only pixels that may see the rod: off the axis of the lens a ball looks longer than wide, by
   less than 2 in pictures of less than 90 degrees. */
static void rod_seen(const Rod *rod, const Lens *lens, const Line *rays, double x, double y,
                     double *enter)
{
    Vec    from = lens_place(lens, rod->from), to = lens_place(lens, rod->to);
    double nearest = fmin(from.z, to.z) - rod->radius, left, right;
    double reach   = 0.1 + 2 * rod->radius / lens_pixel(lens, nearest);
    int    end     = pixel_from(fmax(from.y, to.y) + reach, y, lens->height);
    for (int j = pixel_from(fmin(from.y, to.y) - reach, y, lens->height); j < end; j++) {
        if (!row_part(from, to, j + y, reach, &left, &right))
            continue;
        int excess = pixel_from(right, x, lens->width);
        for (int i = pixel_from(left, x, lens->width); i < excess; i++) {
            int   k     = j * lens->width + i;
            Chord chord = chord_of_rod(rays[k], rod);
            if (!chord_is_empty(chord))
                enter[k] = fmin(enter[k], chord.enter);
        }
    }
}

void rods_seen(const Rod *rods, size_t count, const Lens *lens, double x, double y, double *enter)
{
    int   pixels = lens->width * lens->height;
    Line *rays   = calloc((size_t)pixels, sizeof *rays);
    if (!rays)
        exit(EXIT_FAILURE);
    for (int k = 0; k < pixels; k++) {
        rays[k]  = lens_ray(lens, k % lens->width + x, k / lens->width + y);
        enter[k] = HUGE_VAL;
    }
    for (size_t n = 0; n < count; n++)
        rod_seen(&rods[n], lens, rays, x, y, enter);
    free(rays);
}
