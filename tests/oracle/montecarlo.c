/*
 * montecarlo.c: rays, the light's disc, and the coat of a white surface.
 */
#include "tests/oracle/montecarlo.h"

#define FARTHEST 100.0
#define MIN_STEP 2e-4 /* a ray may miss what is thinner */
#define ABOVE    5e-4 /* where rays from a surface begin */
#define DEGREE   (M_PI / 180)

static double bound_at(const Setting *setting, Vec p)
{
    return setting->room->bound(p, setting->numbers);
}

/* Returns the first place from `t` on at which a line is inside of something; HUGE_VAL: none. */
static double first_inside(const Setting *setting, Line line, double t, double end)
{
    double before = t;
    while (t < end) {
        double distance = bound_at(setting, line_at(line, t));
        if (distance <= 0) {
            while (t - before > 1e-9) {
                double middle = 0.5 * (t + before);
                if (bound_at(setting, line_at(line, middle)) <= 0)
                    t = middle;
                else
                    before = middle;
            }
            return t;
        }
        before = t;
        t += fmax(distance, MIN_STEP);
    }
    return HUGE_VAL;
}

static Vec gradient_at(const Setting *setting, Vec p)
{
    const double step = 1e-6;
    double       d[3];
    for (int i = 0; i < 3; i++) {
        Vec by = vec(i == 0 ? step : 0, i == 1 ? step : 0, i == 2 ? step : 0);
        d[i]   = bound_at(setting, vec_add(p, by)) - bound_at(setting, vec_sub(p, by));
    }
    return vec_unit(vec(d[0], d[1], d[2]));
}

Setting setting_choose(const Room *room, Random *random)
{
    Setting setting = {.room = room};
    for (int i = 0; i < ROOM_NUMBERS; i++)
        setting.numbers[i] = random_between(random, room->numbers[i].low, room->numbers[i].high);
    setting.light = vec(random_between(random, room->light_low.x, room->light_high.x),
                        random_between(random, room->light_low.y, room->light_high.y),
                        random_between(random, room->light_low.z, room->light_high.z));
    setting.wide  = random_between(random, room->wide.low, room->wide.high);
    if (!room->lamp)
        setting.wide *= DEGREE;
    return setting;
}

/* What a mirror of microfacets as rough as can be sends from one direction to another, times the cosine
   of the light's: GGX with Smith's masking, where `head_on` of the light is mirrored head-on. */
static double mirror_of(double light, double eye, double to_halfway, double head_on)
{
    double mirrored = head_on + (1 - head_on) * pow(1 - to_halfway, 5);
    return light * mirrored / M_PI * 0.5 / (light + eye);
}

/* Returns the part of light from all sides that it sends to the eye, by sums over the half sky. */
static double sum_mirrored(double eye, double head_on)
{
    enum { RISES = 200, TURNS = 50 };
    Vec    toward_eye = {sqrt(1 - eye * eye), 0, eye};
    double sum        = 0;
    for (int i = 0; i < RISES; i++)
        for (int k = 0; k < TURNS; k++) {
            double light = (i + 0.5) / RISES, across = sqrt(1 - light * light);
            double turn         = (k + 0.5) * M_PI / TURNS;
            Vec    toward_light = {across * cos(turn), across * sin(turn), light};
            Vec    halfway      = vec_unit(vec_add(toward_eye, toward_light));
            sum += mirror_of(light, eye, vec_dot(toward_eye, halfway), head_on);
        }
    return sum * 2 * M_PI / (RISES * TURNS);
}

#define HEAD_ON 0.04 /* of a body */

/* How often light bounces between microfacets, as a factor, and what the mirror leaves to the body below. */
typedef struct Leaves {
    double bounces, below;
} Leaves;

static Leaves find_leaves(double eye)
{
    enum { STEPS = 64 };
    static Leaves known[STEPS + 1];
    static bool   found;
    for (int i = 0; i <= STEPS && !found; i++) {
        double at = fmax((double)i / STEPS, 1e-3), all = sum_mirrored(at, 1);
        known[i].bounces = 1 + HEAD_ON * (1 - all) / all;
        known[i].below   = 1 - known[i].bounces * sum_mirrored(at, HEAD_ON);
    }
    found        = true;
    double place = fmin(eye, 1) * STEPS, part = place - floor(fmin(place, STEPS - 1));
    Leaves low = known[(int)fmin(place, STEPS - 1)], high = known[(int)fmin(place, STEPS - 1) + 1];
    return (Leaves){low.bounces + part * (high.bounces - low.bounces),
                    low.below + part * (high.below - low.below)};
}

/* Reflectance times cosine of what is white and as rough as can be: Lambert below that mirror. */
static double reflect_white(Vec normal, Vec toward_eye, Vec toward_light)
{
    double light = vec_dot(normal, toward_light), eye = fmax(vec_dot(normal, toward_eye), 1e-3);
    Vec    halfway = vec_unit(vec_add(toward_eye, toward_light));
    Leaves leaves  = find_leaves(eye);
    if (light <= 0)
        return 0;
    return leaves.below * light / M_PI +
           leaves.bounces * mirror_of(light, eye, vec_dot(toward_eye, halfway), HEAD_ON);
}

/* Returns the part of the light's disc that nothing hides from a point. */
static double find_visible(const Setting *setting, Vec point, Vec normal, int rays, Random *random)
{
    Vec    start  = vec_add(point, vec_scale(ABOVE, normal));
    Vec    apart  = setting->room->lamp ? vec_sub(setting->light, start) : vec_unit(setting->light);
    double radius = setting->room->lamp ? setting->wide : tan(setting->wide / 2);
    Vec    axis = vec_unit(apart), lateral = vec_across(axis), other = vec_cross(axis, lateral);
    double turn = random_between(random, 0, 1), shift = random_between(random, 0, 1);
    int    open = 0;
    for (int i = 0; i < rays; i++) {
        double distance  = radius * sqrt((i + shift) / rays);
        double angle     = 2 * M_PI * (turn + 0.6180339887 * i);
        Vec    direction = vec_add(apart, vec_add(vec_scale(distance * cos(angle), lateral),
                                                  vec_scale(distance * sin(angle), other)));
        double end       = setting->room->lamp ? vec_length(direction) : FARTHEST;
        open += first_inside(setting, (Line){start, vec_unit(direction)}, 0, end) > end;
    }
    return (double)open / rays;
}

Seen see(const Setting *setting, Line ray, int rays, Random *random)
{
    Seen   seen = {0};
    double t    = first_inside(setting, ray, 0, FARTHEST);
    if (t > FARTHEST)
        return seen;
    seen.hit      = true;
    seen.point    = line_at(ray, t);
    seen.normal   = gradient_at(setting, seen.point);
    Vec    apart  = setting->room->lamp ? vec_sub(setting->light, seen.point) : setting->light;
    double square = setting->room->lamp ? vec_dot(apart, apart) : 1;
    seen.light = reflect_white(seen.normal, vec_scale(-1, ray.direction), vec_unit(apart)) / square;
    if (seen.light > 0)
        seen.visible = find_visible(setting, seen.point, seen.normal, rays, random);
    return seen;
}

double openness(const Setting *setting, Vec point, Vec normal, double reach, int rays,
                Random *random)
{
    Vec    start   = vec_add(point, vec_scale(ABOVE, normal));
    Vec    lateral = vec_across(normal), other = vec_cross(normal, lateral);
    double turn = random_between(random, 0, 1), shift = random_between(random, 0, 1);
    int    open = 0;
    for (int i = 0; i < rays; i++) {
        double distance = sqrt((i + shift) / rays), angle = 2 * M_PI * (turn + 0.6180339887 * i);
        Vec    direction = vec_add(vec_scale(sqrt(fmax(1 - distance * distance, 0)), normal),
                                   vec_add(vec_scale(distance * cos(angle), lateral),
                                           vec_scale(distance * sin(angle), other)));
        double end       = direction.y < 0 ? reach : FARTHEST;
        open += first_inside(setting, (Line){start, direction}, 0, end) > end;
    }
    return (double)open / rays;
}
