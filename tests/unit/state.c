/*
 * state.c: parameters, time and views through the C interface.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "compiler/passes/compile.h"

static KrsState *open_scene(const char *text, KrsScene **scene)
{
    KrsState *state;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, scene), KRS_OK);
    assert_int_equal(krs_state_new(*scene, &state), KRS_OK);
    return state;
}

static void close_scene(KrsState *state, KrsScene *scene)
{
    krs_state_free(state);
    krs_scene_free(scene);
}

static double distance_at(KrsState *state, double x, double y, double z)
{
    double point[1][3] = {{x, y, z}}, distance;
    krs_distance(state, (const double(*)[3])point, 1, &distance);
    return distance;
}

static void parameters_move_the_scene(void **context)
{
    (void)context;
    KrsScene    *scene;
    KrsParameter parameter;
    KrsState    *state = open_scene("param r = 1 in [0.5, 2]; param at = [1, 0, 0];"
                                       "show sphere(r).move(at + [0, time, 0]);",
                                    &scene);
    assert_int_equal(krs_parameter_count(scene), 2);
    assert_int_equal(krs_parameter(scene, 0, &parameter), KRS_OK);
    assert_string_equal(parameter.name, "r");
    assert_true(parameter.low[0] == 0.5 && parameter.high[0] == 2 && parameter.components == 1);
    assert_int_equal(krs_parameter(scene, 2, &parameter), KRS_BAD_ARGUMENT);

    assert_true(fabs(distance_at(state, 4, 0, 0) - 2) < 1e-12);
    assert_int_equal(krs_state_set(state, "r", (double[]){2}, 1), KRS_OK);
    assert_true(fabs(distance_at(state, 4, 0, 0) - 1) < 1e-12);
    assert_int_equal(krs_state_set(state, "at", (double[]){0, 0, 0}, 3), KRS_OK);
    assert_true(fabs(distance_at(state, 4, 0, 0) - 2) < 1e-12);
    assert_int_equal(krs_state_set_time(state, 3), KRS_OK);
    assert_true(fabs(distance_at(state, 4, 0, 0) - 3) < 1e-12);

    /* What is refused changes nothing. */
    assert_int_equal(krs_state_set(state, "r", (double[]){2.5}, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set(state, "r", (double[]){NAN}, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set(state, "r", (double[]){1, 1}, 2), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set(state, "q", (double[]){1}, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set_time(state, INFINITY), KRS_BAD_ARGUMENT);
    assert_true(fabs(distance_at(state, 4, 0, 0) - 3) < 1e-12);
    close_scene(state, scene);
}

/* Returns the distance of a scene that chooses a radius and a place by `index`, which may use `k`. */
static double chosen_at(const char *index, double k)
{
    char text[600];
    snprintf(text, sizeof text,
             "param k = 0 in [-100, 100]; let radii = [0.5, 0.7, 0.6 + 0.001 * k, 0.9, 0.8];"
             "let at = [[1, 0, 0], [0, 2, 0], [k, 0, 3], [4, 4, 0], [0, 0, 5]];"
             "let i = %s; show sphere(radii[i]).move(at[i] + [0, 0, [7, 8, 9][clamp(i, 0, 2)]]);",
             index);
    KrsScene *scene;
    KrsState *state = open_scene(text, &scene);
    assert_int_equal(krs_state_set(state, "k", (double[]){k}, 1), KRS_OK);
    const double distance = distance_at(state, 0.3, -0.4, 0.2);
    close_scene(state, scene);
    return distance;
}

/* An index that states know chooses what the same number would, and is rounded down. */
static void lists_are_indexed_by_what_states_know(void **context)
{
    (void)context;
    static const char *const whole[] = {"0", "1", "2", "3", "4"};
    double                   seen[5];
    bool                     found[5] = {false};
    for (int i = 0; i < 5; i++) {
        seen[i] = chosen_at(whole[i], i + 0.75);
        assert_true(chosen_at("clamp(k, 0, 4.9)", i + 0.75) == seen[i]);
    }
    for (int k = -20; k <= 20; k++) {
        const double distance = chosen_at("floor(5 * random(k))", k);
        int          number   = 0;
        while (number < 5 && fabs(distance - chosen_at(whole[number], k)) > 1e-12)
            number++;
        assert_true(number < 5);
        found[number] = true;
    }
    assert_true(found[0] && found[1] && found[2] && found[3] && found[4]);
}

/* The largest number below 1, times the length of the list, is below that length. */
static void an_index_may_come_near_to_the_length(void **context)
{
    (void)context;
    char most[40], text[200];
    snprintf(most, sizeof most, "%.17g", nextafter(1, 0));
    for (int n = 1; n < 9; n++) {
        snprintf(text, sizeof text,
                 "param k = 0 in [0, %s]; show sphere([j for j in 1..%d][floor(%d * k)]);", most,
                 n + 1, n);
        KrsScene *scene;
        KrsState *state = open_scene(text, &scene);
        assert_int_equal(krs_state_set(state, "k", (double[]){nextafter(1, 0)}, 1), KRS_OK);
        assert_true(fabs(distance_at(state, 20, 0, 0) - (20 - n)) < 1e-12);
        close_scene(state, scene);
    }
}

static void states_that_are_not_finite_are_refused(void **context)
{
    (void)context;
    KrsScene *scene;
    KrsState *state = open_scene("param a = 0.5 in [-1, 1]; show sphere(2 + sqrt(a));", &scene);
    assert_int_equal(krs_state_set(state, "a", (double[]){-1}, 1), KRS_BAD_ARGUMENT);
    assert_true(fabs(distance_at(state, 4, 0, 0) - (2 - sqrt(0.5))) < 1e-12);
    assert_int_equal(krs_state_set(state, "a", (double[]){1}, 1), KRS_OK);
    close_scene(state, scene);

    /* A root that is chosen against does no harm. */
    state = open_scene("param a = 0.5 in [-1, 1]; show sphere(if a < 0 then 1 else 1 + sqrt(a));",
                       &scene);
    assert_int_equal(krs_state_set(state, "a", (double[]){-1}, 1), KRS_OK);
    assert_true(fabs(distance_at(state, 4, 0, 0) - 3) < 1e-12);
    close_scene(state, scene);
}

static bool holds_number(const float *numbers, size_t count, double number)
{
    bool found = false;
    for (size_t i = 0; i < count; i++)
        found = found || fabs(numbers[i]) == fabs((double)(float)number);
    return found;
}

/* What depends on the state alone is found in double precision, after each change; what is the same
   in all states has no place, and neither has a parameter. */
static void values_of_states_are_found(void **context)
{
    (void)context;
    KrsScene *scene;
    float     block[4][4];
    KrsState *state = open_scene("param a = 0.3 in [0, 2]; param on = 1 in [0, 1];\n"
                                 "show sphere(1.5 + sin(a)).move([0 * a, cos(a + time), a]);\n"
                                 "show sphere(if on > 0.5 then exp(a) else 7).move([9, 0, 0]);",
                                 &scene);
    assert_in_range(krs_value_slots(scene), 1, 4);
    for (double a = 0.3; a < 2; a += 0.7) {
        assert_int_equal(krs_state_set(state, "a", &a, 1), KRS_OK);
        assert_int_equal(krs_state_set_time(state, 3 * a), KRS_OK);
        krs_state_values(state, block);
        size_t count = 4 * krs_value_slots(scene);
        assert_true(holds_number(block[0], count, 1.5 + sin(a)));
        assert_true(holds_number(block[0], count, cos(4 * a)));
        assert_true(holds_number(block[0], count, exp(a)));
        assert_false(holds_number(block[0], count, a));
        assert_int_equal(krs_state_set(state, "on", (double[]){a < 1}, 1), KRS_OK);
        krs_state_values(state, block);
        assert_true(holds_number(block[0], count, a < 1 ? exp(a) : 7));
        assert_int_equal(krs_state_set(state, "on", (double[]){1}, 1), KRS_OK);
    }
    close_scene(state, scene);

    state = open_scene("show sphere(1);", &scene);
    assert_int_equal(krs_value_slots(scene), 0);
    close_scene(state, scene);
}

/* A state in which something has no slope is refused by name, and leaves everything as it was. */
static void states_without_a_slope_are_refused(void **context)
{
    (void)context;
    KrsScene     *scene;
    KrsStateSlope slope;
    float         before[4][4], after[4][4];
    KrsState     *state = open_scene("param k = 1;\nlet f = field(y - sin(k * x / (time - 2)));\n"
                                         "show f; show f.move([0, 5, 0]);",
                                     &scene);
    assert_int_equal(krs_state_slope_count(scene), 1); /* one expression */
    assert_int_equal(krs_state_slope(scene, 0, &slope), KRS_OK);
    assert_int_equal(krs_state_slope(scene, 1, &slope), KRS_BAD_ARGUMENT);
    assert_string_equal(slope.location, "scene.krs:2:9");
    assert_true(slope.low[0] == -INFINITY && slope.high[2] == INFINITY);
    assert_int_equal(krs_parameter_slots(scene), 3);
    assert_int_equal(slope.slot, 2);

    assert_int_equal(krs_state_set_time(state, 1), KRS_OK);
    krs_state_parameters(state, before);
    assert_true(before[2][0] > 1.41421f && before[2][0] < 1.4143f);
    double distance = distance_at(state, 3, 2, 1);
    assert_int_equal(krs_state_set_time(state, 2), KRS_BAD_ARGUMENT);
    assert_string_equal(krs_state_unbounded(state), "scene.krs:2:9");
    krs_state_parameters(state, after);
    assert_memory_equal(before, after, 3 * sizeof *before);
    assert_true(distance_at(state, 3, 2, 1) == distance);
    assert_int_equal(krs_state_set_time(state, INFINITY), KRS_BAD_ARGUMENT);
    assert_null(krs_state_unbounded(state));
    assert_int_equal(krs_state_set(state, "k", (double[]){1e38}, 1), KRS_BAD_ARGUMENT);
    assert_non_null(krs_state_unbounded(state));
    assert_int_equal(krs_state_set(state, "k", (double[]){10}, 1), KRS_OK);
    assert_null(krs_state_unbounded(state));
    krs_state_parameters(state, after);
    assert_true(after[2][0] > 10);
    close_scene(state, scene);
}

/* Nor may a quotient of zeros seem to have the slope 0. */
static void nothing_over_nothing_has_no_slope(void **context)
{
    (void)context;
    KrsScene *scene;
    KrsState *state = open_scene("param k = 1; show field(y + sin(x * time / k));", &scene);
    assert_int_equal(krs_state_set(state, "k", (double[]){0}, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set(state, "k", (double[]){0.5}, 1), KRS_OK);
    close_scene(state, scene);
}

/* What is cut has its slope in the region; that of the whole field is of no use then. */
static void a_cut_field_has_one_slope(void **context)
{
    (void)context;
    KrsScene     *scene;
    KrsStateSlope slope;
    KrsState *state = open_scene("show field(y - sin(x * time)).within(box([2, 2, 2]));", &scene);
    assert_int_equal(krs_state_slope_count(scene), 1);
    assert_int_equal(krs_state_slope(scene, 0, &slope), KRS_OK);
    assert_true(slope.low[0] == -1 && slope.high[2] == 1);
    close_scene(state, scene);

    /* A parameter with a range needs none. */
    state = open_scene("param k = 1 in [0, 9]; show field(y - sin(x * k));", &scene);
    assert_int_equal(krs_state_slope_count(scene), 0);
    close_scene(state, scene);
}

/* A constant that is far above the slopes of states gives way to them, whose values count. */
static void far_steeper_ranges_have_slopes_of_states(void **context)
{
    (void)context;
    static const double values[] = {1, 0.5, 300, 900, 0};
    KrsScene           *scene;
    KrsStateSlope       slope;
    float               block[4][4];
    KrsState *state = open_scene("param k = 1 in [0, 900]; show field(y - sin(x * k));", &scene);
    assert_int_equal(krs_state_slope_count(scene), 1);
    assert_int_equal(krs_state_slope(scene, 0, &slope), KRS_OK);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        const double steepest = hypot(1, values[i]);
        assert_int_equal(krs_state_set(state, "k", &values[i], 1), KRS_OK);
        krs_state_parameters(state, block);
        assert_true((double)block[slope.slot][0] >= steepest);
        assert_true((double)block[slope.slot][0] <= 1.00001 * steepest);
        assert_true(fabs(distance_at(state, 0, 3, 0)) <= 3 / steepest);
    }
    close_scene(state, scene);

    /* Not where the first state is as steep, nor where cells without end have no slope in common. */
    state = open_scene("param k = 1 in [0, 900]; show field(y + 90 * x - sin(x * k));", &scene);
    assert_int_equal(krs_state_slope_count(scene), 0);
    close_scene(state, scene);
    state = open_scene("param k = 1 in [0, 900];\n"
                       "def wave(cell) = field(y - 0.1 * sin(k * random(cell) * x))"
                       ".within(box([0.5, 0.5, 0.5]));\nshow wave.repeat([1, 0, 1]);",
                       &scene);
    assert_int_equal(krs_state_slope_count(scene), 0);
    close_scene(state, scene);
}

/* Lights, sky and fog follow the values of a state, as programs are told them. */
static void lights_are_told(void **context)
{
    (void)context;
    KrsScene *scene;
    KrsLight  light;
    KrsSky    sky;
    KrsFog    fog;
    KrsState *state = open_scene(
        "param power = 2 in [0, 9];\n"
        "light lamp { position: [0, 3 + time, 0], color: [1, 0.5, 0.25], intensity: power, radius: "
        "0.1 }\n"
        "light panel { position: [5, 5, 5], target: [5, 0, 5], size: [2, 1], shadow: false }\n"
        "sky { zenith: [0.1, 0.2, power], horizon: [1, 1, 1], ground: [0, 0, 0] }\n"
        "fog { color: [0.5, 0.5, 0.5], density: 0.01 * power }\n"
        "show sphere(1);",
        &scene);
    assert_int_equal(krs_light_count(scene), 2);
    assert_string_equal(krs_light_name(scene, 1), "panel");
    assert_int_equal(krs_state_set(state, "power", (double[]){4}, 1), KRS_OK);
    assert_int_equal(krs_state_set_time(state, 0.5), KRS_OK);
    assert_int_equal(krs_state_light(state, 0, &light), KRS_OK);
    assert_true(light.positional && light.shadow && light.type == KRS_LIGHT_ROUND);
    assert_true(fabs(light.vector[1] - 3.5) < 1e-12);
    assert_true(fabs(light.color[1] - 2) < 1e-12);
    assert_true(fabs(light.softness - 0.1) < 1e-12);
    assert_int_equal(krs_state_light(state, 1, &light), KRS_OK);
    assert_true(!light.shadow && light.type == KRS_LIGHT_RECTANGLE);
    assert_true(fabs(light.axis[1] + 1) < 1e-12);
    assert_true(fabs(light.size[0] - 2) < 1e-12);
    assert_int_equal(krs_state_light(state, 2, &light), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_sky(state, &sky), KRS_OK);
    assert_true(!sky.map);
    assert_true(fabs(sky.zenith[2] - 4) < 1e-12);
    assert_int_equal(krs_state_fog(state, &fog), KRS_OK);
    assert_true(fabs(fog.density - 0.04) < 1e-12);
    close_scene(state, scene);
    state = open_scene(
        "light sun { direction: [0, 1, 1] } sky { sun: sun, turbidity: 3 } show sphere(1);",
        &scene);
    assert_int_equal(krs_state_sky(state, &sky), KRS_OK);
    assert_non_null(sky.map);
    assert_true(sky.map->width > 0 && sky.map->texels[0][2] > 0);
    close_scene(state, scene);
}

/* The library prints a scene alone, for engines of others, in memory of the caller. */
static void texts_are_printed(void **context)
{
    (void)context;
    KrsScene *scene;
    char     *plain, *values, *none;
    KrsState *state = open_scene(
        "param k = 1 in [0, 9]; show sphere(1).rotate([0, 1, 0], sin(k + time));", &scene);
    assert_int_equal(krs_text(scene, KRS_TARGET_GLSL, NULL, &plain), KRS_OK);
    assert_non_null(strstr(plain, "float krs_distance(vec3 p)"));
    assert_non_null(strstr(plain, "float krs_distance_lod("));
    assert_non_null(strstr(plain, "krs_sin("));
    assert_int_equal(krs_text(scene, KRS_TARGET_GLSL,
                              &(KrsTextOptions){.state_values = true, .no_early_outs = true},
                              &values),
                     KRS_OK);
    assert_null(strstr(values, "krs_distance_lod("));
    assert_null(strstr(values, "krs_sin("));
    assert_int_equal(krs_text(scene, KRS_TARGET_COUNT, NULL, &none), KRS_BAD_ARGUMENT);
    assert_null(none);
    free(plain);
    free(values);
    close_scene(state, scene);
}

/* Returns the angle between the view axis and a point, seen from the eye. */
static double angle_to(const KrsCamera *camera, double x, double y, double z)
{
    double to[3] = {x, y, z}, along = 0, a = 0, b = 0;
    for (int k = 0; k < 3; k++) {
        double axis = camera->target[k] - camera->eye[k], distance = to[k] - camera->eye[k];
        along += axis * distance;
        a += axis * axis;
        b += distance * distance;
    }
    return acos(along / sqrt(a * b));
}

static void a_missing_camera_frames_the_scene(void **context)
{
    (void)context;
    /* The box of a sequence with a moving mirror is far larger than what is there. */
    KrsScene *scene;
    KrsView   view;
    KrsState *state = open_scene("param w = 1 in [1, 50]; show plane([0, 1, 0], -1);"
                                 "show krs { kernel sphere(0.5); reflect plane([1, 0, 0], w); };",
                                 &scene);
    assert_int_equal(krs_state_view(state, 0, &view), KRS_OK);
    double half = 0.5 * view.camera.fov;
    double left = angle_to(&view.camera, -0.5, 0, 0), right = angle_to(&view.camera, 2.5, 0, 0);
    assert_true(left < half && right < half);
    assert_true(left > 0.3 * half && right > 0.3 * half);
    assert_int_equal(krs_state_view(state, 1, &view), KRS_BAD_ARGUMENT);
    close_scene(state, scene);
}

/* Returns where a point is in the picture: upwards, or to the right; 1 is half the height. */
static double place_of(const KrsCamera *camera, const double point[3], bool upwards)
{
    double out[3], right[3], up[3], to[3];
    for (int k = 0; k < 3; k++) {
        out[k] = camera->target[k] - camera->eye[k];
        to[k]  = point[k] - camera->eye[k];
    }
    normalize3(out);
    cross3(out, (double[]){0, 1, 0}, right);
    normalize3(right);
    cross3(right, out, up);
    return dot3(to, upwards ? up : right) / (dot3(to, out) * tan(0.5 * camera->fov));
}

/* How much of the height of the picture a box fills by its corners, along one of its axes; and how far
   its middle is from that of the picture. */
static double box_fills(const char *text, const double size[3], bool upwards, double *middle)
{
    KrsScene *scene;
    KrsView   view;
    KrsState *state = open_scene(text, &scene);
    double    low = HUGE_VAL, high = -HUGE_VAL;
    assert_int_equal(krs_state_view(state, 0, &view), KRS_OK);
    for (int i = 0; i < 8; i++) {
        double corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = (i >> k & 1 ? 0.5 : -0.5) * size[k];
        double at = place_of(&view.camera, corner, upwards);
        low       = fmin(low, at);
        high      = fmax(high, at);
    }
    close_scene(state, scene);
    *middle = 0.5 * (low + high);
    return 0.5 * (high - low);
}

/* A ball fills two thirds of the height, what is tall or wide most of it, and a plate is in the middle. */
static void the_scene_fills_the_picture(void **context)
{
    (void)context;
    KrsScene *scene;
    KrsView   view;
    KrsState *state = open_scene("show sphere(2).move([9, 1, 7]);", &scene);
    assert_int_equal(krs_state_view(state, 0, &view), KRS_OK);
    double away = distance3(view.camera.eye, (double[]){9, 1, 7});
    assert_float_equal(tan(asin(2 / away)) / tan(0.5 * view.camera.fov), 0.67, 0.04);
    assert_true(angle_to(&view.camera, 9, 1, 7) < 0.02);
    close_scene(state, scene);

    double middle,
        tall = box_fills("show box([0.2, 5, 0.2]);", (double[]){0.2, 5, 0.2}, true, &middle);
    assert_float_equal(tall, 0.82, 0.06);
    double wide = box_fills("show box([4, 0.1, 4]);", (double[]){4, 0.1, 4}, false, &middle);
    assert_float_equal(wide, 0.95, 0.06);
    box_fills("show box([4, 0.1, 4]);", (double[]){4, 0.1, 4}, true, &middle);
    assert_float_equal(middle, 0, 0.03);
}

/* Few rays hit what is thin, and the first that do may all hit one part of it.  Ends of rods are known. */
static void thin_things_are_framed_whole(void **context)
{
    (void)context;
    static const double ends[][3] = {{0, 0, 0},  {0, 9, 0}, {-4, 9, 1},
                                     {4, 9, -1}, {0, 4, 3}, {-5, -3, 0}};
    KrsScene           *scene;
    KrsView             view;
    KrsState           *state = open_scene(
                  "let r = 0.02;"
                            "show capsule([0, 0, 0], [0, 9, 0], r) |"
                            "capsule([-4, 9, 1], [4, 9, -1], r) |"
                            "capsule([0, 3, 0], [0, 4, 3], r) |"
                            "capsule([-5, -3, 0], [0, 0, 0], r) | sphere(0.7).move([0, 2, 0]);",
                  &scene);
    assert_int_equal(krs_state_view(state, 0, &view), KRS_OK);
    double half = 0.5 * view.camera.fov, widest = 0;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        double angle = angle_to(&view.camera, ends[i][0], ends[i][1], ends[i][2]);
        assert_true(angle < half);
        widest = fmax(widest, angle);
    }
    assert_true(widest > 0.6 * half);
    close_scene(state, scene);
}

/* A column without end in y must not be framed, nor what is seen of it. */
static void endless_components_are_not_framed(void **context)
{
    (void)context;
    KrsScene *scene;
    KrsView   view;
    KrsState *state = open_scene("show sphere(0.5); show cylinder(0.2, 0.9)"
                                 ".move([1.5, 0, 0]).repeat([0, 1, 0]);",
                                 &scene);
    assert_int_equal(krs_state_view(state, 0, &view), KRS_OK);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(view.camera.target[k]) < 0.1);
    close_scene(state, scene);
}

/* Directions may have any length but 0. */
static void rays_of_any_length_hit(void **context)
{
    static const double lengths[] = {1e-300, 1e-160, 1e-3, 1, 1e200, 1e300};
    (void)context;
    KrsScene *scene;
    KrsState *state = open_scene("show sphere(1);", &scene);
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        const double origin[1][3] = {{0, 0, 3}}, direction[1][3] = {{0, 0, -lengths[i]}};
        KrsHit       hit;
        krs_raycast(state, origin, direction, 1, 10, 0, &hit);
        assert_true(hit.hit && fabs(hit.t - 2) < 1e-6);
    }
    close_scene(state, scene);
}

/* What is not there is a mistake of the caller, and changes nothing. */
static void pointers_that_are_null_are_refused(void **context)
{
    (void)context;
    static const char text[]   = "param r = 1 in [0.1, 2]; show sphere(r);";
    const double      value[1] = {0.5};
    KrsScene         *scene = (KrsScene *)1, *other = (KrsScene *)1;
    KrsState         *state;
    char             *formatted = (char *)1;
    bool              same;
    double            distance[1];
    KrsHit            hit;
    assert_int_equal(krs_compile_text(NULL, 4, "a.krs", NULL, &scene), KRS_BAD_ARGUMENT);
    assert_null(scene);
    assert_int_equal(krs_compile_text(text, sizeof text - 1, NULL, NULL, &scene), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_compile_file(NULL, NULL, &scene), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_format_file(NULL, NULL, &formatted, &same), KRS_BAD_ARGUMENT);
    assert_null(formatted);
    assert_int_equal(krs_compile_text(text, sizeof text - 1, "a.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_scene_update(scene, NULL, 3, &other, NULL), KRS_BAD_ARGUMENT);
    assert_null(other);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_set(state, NULL, value, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set(state, "r", NULL, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set_zones(state, NULL, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set_zones(state, NULL, 0), KRS_OK);
    assert_int_equal(krs_distance(state, NULL, 1, distance), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_normal(state, NULL, 1, &hit.normal), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_probe(state, NULL, 1, &hit), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(state, NULL, NULL, 1, 1, 0, &hit), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_distance(state, &(const double[3]){3, 0, 0}, 1, distance), KRS_OK);
    assert_true(fabs(distance[0] - 2) < 1e-12);
    krs_state_free(state);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pointers_that_are_null_are_refused),
        cmocka_unit_test(parameters_move_the_scene),
        cmocka_unit_test(lists_are_indexed_by_what_states_know),
        cmocka_unit_test(an_index_may_come_near_to_the_length),
        cmocka_unit_test(states_that_are_not_finite_are_refused),
        cmocka_unit_test(values_of_states_are_found),
        cmocka_unit_test(states_without_a_slope_are_refused),
        cmocka_unit_test(nothing_over_nothing_has_no_slope),
        cmocka_unit_test(a_cut_field_has_one_slope),
        cmocka_unit_test(far_steeper_ranges_have_slopes_of_states),
        cmocka_unit_test(lights_are_told),
        cmocka_unit_test(texts_are_printed),
        cmocka_unit_test(a_missing_camera_frames_the_scene),
        cmocka_unit_test(the_scene_fills_the_picture),
        cmocka_unit_test(thin_things_are_framed_whole),
        cmocka_unit_test(endless_components_are_not_framed),
        cmocka_unit_test(rays_of_any_length_hit),
    };
    return cmocka_run_group_tests_name("states", tests, NULL, NULL);
}
