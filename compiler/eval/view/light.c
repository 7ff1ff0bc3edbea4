/*
 * light.c: lights: where they are, and what they shine from.
 */
#include "compiler/eval/view/view.h"

/* ---- kinds of lights.def ---- */

static Node ask_vector(const Asked *a, const char *name, const double otherwise[4])
{
    return find_property(a->block, "position") ? ask_place(a, name, otherwise)
                                               : ask_axis(a, name, otherwise);
}

static Node ask_color(const Asked *a, const char *name, const double otherwise[4])
{
    return ask_axis(a, name, otherwise);
}

/* Returns two lengths. */
static Node ask_sides(const Asked *a, const char *name, const double otherwise[4])
{
    Elaboration  *e     = a->e;
    const Syntax *size  = find_property(a->block, name);
    Value         value = size ? evaluate(e, a->env, size) : (Value){.type = VALUE_ERROR};
    Node          sides[2];
    bool          good = value.type == VALUE_LIST && value.list->count == 2;
    for (int i = 0; good && i < 2; i++) {
        good     = value_size(e, value.list->items[i]) == 1;
        sides[i] = good ? value_node(e, value.list->items[i]) : NODE_NONE;
        good     = good && node_range(e->builder, sides[i], 0).low >= 0;
    }
    if (good)
        return graph_op3(e->graph, OP_vec3, sides[0], sides[1], graph_number(e->graph, 0));
    if (value.type != VALUE_ERROR) {
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, size->span,
                              "`%s` of a light must be two lengths that are not negative", name);
        diag->help = diag_text(e->diags, "for example `%s: [2, 1]`: how wide and how high it is",
                               name);
    }
    return graph_constant(e->graph, TYPE_VEC3, otherwise);
}

/* ---- what is refused, or warned of ---- */

/* Warns of numbers that seem to be in another unit. */
static void warn_of_light(const Asked *a)
{
    static const char *const angles[] = {"softness", "angle"};
    const Syntax            *color    = find_property(a->block, "color");
    if (color)
        warn_of_bright_colour(a->e, color, evaluate(a->e, a->env, color),
                              "how bright a light is, is its `intensity`");
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        const Syntax *angle = find_property(a->block, angles[i]);
        if (angle)
            warn_of_revolutions(a->e, angle, evaluate(a->e, a->env, angle));
    }
}

/* Refuses properties that only lights at a position have. */
static void refuse_placed(Elaboration *e, const Syntax *syntax)
{
    static const struct {
        const char *of_direction, *of_position;
    } rows[] = {
#define KRS_LIGHT(member, kind, of_direction, of_position, ...) {of_direction, of_position},
#include "krs/lights.def"
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const Syntax *given = find_property(syntax, rows[i].of_position);
        if (rows[i].of_direction || !given)
            continue;
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, given->span,
                              "a light of a `direction` has no `%s`", rows[i].of_position);
        diag->help =
            "a light at a `position` has: `light lamp { position: [0, 3, 0], angle: 40deg }`";
    }
}

/* ---- lights ---- */

static uint32_t type_of(const Syntax *syntax)
{
    uint32_t type = 0;
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc) \
    type = find_property(syntax, #given) ? number : type;
#include "krs/light_types.def"
    return type;
}

static bool casts_shadow(const Asked *a)
{
    const Syntax *shadow = find_property(a->block, "shadow");
    Value         value  = shadow ? evaluate(a->e, a->env, shadow) : value_boolean(true);
    if (value.type == VALUE_BOOLEAN)
        return value.boolean;
    type_error(a->e, shadow, value, "true or false");
    return true;
}

SceneLight read_light(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Asked asked = {e, env, syntax, NULL};
    SceneLight  light = {.name       = syntax->name,
                         .positional = find_property(syntax, "position") != NULL,
                         .shadow     = casts_shadow(&asked),
                         .spot       = find_property(syntax, "angle") != NULL,
                         .colored    = find_property(syntax, "color") != NULL,
                         .type       = type_of(syntax)};
#define KRS_LIGHT(member, kind, of_direction, of_position, ...)                 \
    light.nodes.member = ask_##kind(                                            \
        &asked, light.positional || !of_direction ? of_position : of_direction, \
        (const double[4]){__VA_ARGS__});
#include "krs/lights.def"
    light.nodes.color = graph_op2(e->graph, OP_scale, light.nodes.color, light.nodes.intensity);
    return light;
}

void elaborate_light(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Asked   asked     = {e, env, syntax, NULL};
    const Syntax *direction = find_property(syntax, "direction");
    const Syntax *position  = find_property(syntax, "position");
    const Syntax *intensity = find_property(syntax, "intensity");
    if (!direction == !position) {
        Diag *diag = diag_add(e->diags, direction ? DIAG_TOO_MANY_ARGUMENTS : DIAG_MISSING_ARGUMENT,
                              syntax->name_span,
                              "a light has either a `direction` or a `position`");
        diag->help = "for example `light sun { direction: [-1, 2, 1], intensity: 3 }`";
        return;
    }
    SceneLight light = read_light(e, env, syntax);
    light.span       = (intensity ? intensity : position ? position : direction)->span;
    warn_of_light(&asked);
    if (direction) {
        check_direction(e, light.nodes.vector, direction, "the direction of a light");
        refuse_placed(e, syntax);
    }
    array_push(e->arena, &e->scene->lights, light);
}
