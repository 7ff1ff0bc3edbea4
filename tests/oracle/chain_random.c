/*
 * chain_random.c: random solids, link by link: what the language refuses is chosen again.
 */
#include "tests/oracle/chain.h"

#include <stdio.h>

bool chain_box(const Product *product, Vec *low, Vec *high)
{
    KrsComponent component;
    assert_int_equal(krs_component(product->scene, 0, &component), KRS_OK);
    const double *l = component.low, *h = component.high;
    *low  = vec(l[0], l[1], l[2]);
    *high = vec(h[0], h[1], h[2]);
    return isfinite(vec_length(*low)) && isfinite(vec_length(*high));
}

/* What the compiler says of a solid so far. */
typedef struct Known {
    bool refused, bounded;
    Vec  low, high;
} Known;

/* `turned`: after the turn that takes this axis to y. */
static Known ask_about(Chain *chain, int root, const Vec *turned)
{
    static SceneText text;
    Known            known = {.refused = true};
    chain->root            = root;
    text.length            = 0;
    chain_write(chain, &text);
    if (turned) {
        text.length -= 2;
        scene_write(&text, ".align([%.17g, %.17g, %.17g], [0, 1, 0]);\n", turned->x, turned->y,
                    turned->z);
    }
    scene_write(&text, "camera { eye: [0, 0, 9], target: [0, 0, 0] }\n");
    Product product = {0};
    if (krs_compile_text(text.bytes, text.length, "chain.krs", NULL, &product.scene) != KRS_OK)
        return known;
    known.refused = false;
    known.bounded = chain_box(&product, &known.low, &known.high);
    krs_scene_free(product.scene);
    return known;
}

static double size_of(const Known *known)
{
    return fmax(vec_length(known->low), vec_length(known->high));
}

static int add(Chain *chain, Link link)
{
    assert_true(chain->count < MAX_LINKS);
    chain->links[chain->count] = link;
    return chain->count++;
}

static double random_side(Random *random) { return random_below(random, 2) ? 1 : -1; }

static Vec random_axis(Random *random)
{
    static const Vec axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int              axis    = random_below(random, 5);
    return axis < 3 ? vec_scale(random_side(random), axes[axis]) : random_unit(random);
}

/* With a range around the number, in which it keeps its sign. */
static void let_move(Link *link, Random *random)
{
    double size = fabs(link->number);
    link->moves = true;
    link->least = link->number - size * random_between(random, 0, 0.3);
    link->most  = link->number + size * random_between(random, 0, 0.3);
}

static int random_primitive(Chain *chain, const Recipe *recipe, Random *random)
{
    Link link   = {.kind = random_below(random, LINK_PRIMITIVES), .solids = {-1, -1}};
    link.v      = vec(random_between(random, 0.15, 0.7), random_between(random, 0.15, 0.9),
                      random_between(random, 0.15, 0.7));
    link.number = random_between(random, 0.1, 0.5);
    if (link.kind == LINK_RING)
        link.v.x += 0.5;
    if (link.kind == LINK_GROWN || link.kind == LINK_HOLLOW || link.kind == LINK_WAVY)
        link.number *= 0.25;
    if (link.kind == LINK_BLEND)
        link.w = random_in_cube(random, 0.8);
    if (recipe->moving && random_below(random, 2))
        let_move(&link, random);
    return add(chain, link);
}

/* Cells that the solid fits: as large as its box or larger. */
static bool fill_repeat(Link *link, const Known *known, Random *random)
{
    const double low[3]  = {known->low.x, known->low.y, known->low.z};
    const double high[3] = {known->high.x, known->high.y, known->high.z};
    double       period[3], count[3];
    for (int i = 0; i < 3; i++) {
        double half   = fmax(fabs(low[i]), fabs(high[i]));
        count[i]      = 1 + random_below(random, 3);
        bool touches  = random_below(random, 3) == 0;
        period[i]     = 2 * half * (touches ? 1 : random_between(random, 1, 1.4));
        link->touches = link->touches || touches;
    }
    link->v = vec(period[0], period[1], period[2]);
    link->w = vec(count[0], count[1], count[2]);
    return size_of(known) < 4;
}

/* What touches where it is cut and pulled apart would have no depth in between. */
static bool chain_touches(const Chain *chain)
{
    for (int i = 0; i < chain->count; i++)
        if (chain->links[i].touches)
            return true;
    return false;
}

/* Fills the numbers of a method on a solid of which this is known; false: that is not to be had. */
static bool fill_method(Chain *chain, Link *link, const Known *known, Random *random)
{
    double size  = known->bounded ? size_of(known) : 2;
    link->v      = random_axis(random);
    link->length = random_below(random, 2) ? 1 : random_between(random, 0.2, 3);
    switch (link->kind) {
    case LINK_MOVE:
        link->v      = random_in_cube(random, random_below(random, 3) ? 1.5 : 5);
        link->number = link->v.x;
        return true;
    case LINK_TURN: link->number = random_between(random, -4, 4); return true;
    case LINK_SCALE: link->number = random_between(random, 0.4, 1.7); return true;
    case LINK_STRETCH:
        link->v      = vec(0, random_between(random, 0.5, 1.6), random_between(random, 0.5, 1.6));
        link->number = random_between(random, 0.5, 1.6);
        return true;
    case LINK_MIRROR: link->number = random_between(random, -0.4, 0.8) * size; return true;
    case LINK_REPEAT: return known->bounded && fill_repeat(link, known, random);
    case LINK_POLAR: link->w.x = 2 + random_below(random, 6); return true;
    case LINK_TWIST:
        link->number = random_side(random) * pow(10, random_between(random, -1, 0.3));
        return known->bounded;
    case LINK_BEND:
        link->number = random_side(random) * pow(10, random_between(random, -1, 0.9)) / size;
        link->high   = size;
        return known->bounded;
    case LINK_TAPER: {
        Known raised = ask_about(chain, link->solids[0], &link->v);
        link->number = random_between(random, 0.3, 1.6);
        link->w.x    = random_between(random, 0.3, 1.6);
        link->low    = raised.low.y;
        link->high   = raised.high.y;
        return known->bounded && !raised.refused && link->high > link->low;
    }
    case LINK_ELONGATE:
        link->v = vec_add(vec(0.4, 0.4, 0.4), random_in_cube(random, 0.4));
        return !chain_touches(chain);
    case LINK_INVERT:
        link->v      = random_in_cube(random, 2);
        link->number = random_between(random, 0.7, 2.5);
        return known->bounded;
    default: /* WITHIN */
        link->w      = random_in_cube(random, 0.5);
        link->number = random_between(random, 0.5, 1.2) * fmin(size, 3);
        return true;
    }
}

/* Returns the solid after a random method, or the one before where the language or the size refuses
   it: a bend that would reach its axis is tried again. */
static int random_method(Chain *chain, int solid, Known *known, const Recipe *recipe,
                         Random *random, Refusals *refusals)
{
    const double LARGEST = 12;
    enum { TRIALS = 4 };
    Link link = {.solids = {solid, -1}};
    do
        link.kind = LINK_PRIMITIVES + random_below(random, LINK_METHODS - LINK_PRIMITIVES);
    while (recipe->only && !(recipe->only >> link.kind & 1));
    bool numbered = link.kind != LINK_REPEAT && link.kind != LINK_POLAR &&
                    link.kind != LINK_ELONGATE;
    for (int i = 0; i < TRIALS; i++) {
        if (!fill_method(chain, &link, known, random))
            return solid;
        if (recipe->moving && numbered && random_below(random, 2))
            let_move(&link, random);
        int   next  = add(chain, link);
        Known after = ask_about(chain, next, NULL);
        refusals->tried++;
        refusals->refused += after.refused;
        if (!after.refused && !(after.bounded && size_of(&after) > LARGEST)) {
            *known = after;
            return next;
        }
        chain->count--;
    }
    return solid;
}

static int random_solid(Chain *chain, const Recipe *recipe, int csg_nodes, Random *random,
                        Refusals *refusals)
{
    int solid;
    if (csg_nodes > 0 && chain->count < MAX_LINKS / 2) {
        int  left      = random_below(random, csg_nodes);
        Link link      = {.kind   = LINK_METHODS + random_below(random, LINK_KINDS - LINK_METHODS),
                          .v      = random_axis(random),
                          .number = random_between(random, -0.3, 0.6)};
        link.solids[0] = random_solid(chain, recipe, left, random, refusals);
        link.solids[1] = random_solid(chain, recipe, csg_nodes - 1 - left, random, refusals);
        if (link.kind == LINK_MOBIUS) {
            link.v      = random_in_cube(random, 2);
            link.number = random_between(random, 0.7, 2.5);
        }
        solid = add(chain, link);
        if (ask_about(chain, solid, NULL).refused) /* what is endless is not inverted */
            chain->links[solid].kind = LINK_UNION;
    } else
        solid = random_primitive(chain, recipe, random);
    int   methods = random_below(random, recipe->methods + 1);
    Known known   = {.refused = true};
    if (methods)
        known = ask_about(chain, solid, NULL);
    for (int i = 0; i < methods && !known.refused && chain->count < MAX_LINKS / 2; i++)
        solid = random_method(chain, solid, &known, recipe, random, refusals);
    return solid;
}

static void note_kinds(Chain *chain, int at)
{
    const Link *link         = &chain->links[at];
    chain->shown[link->kind] = true;
    for (int i = 0; i < 2 && link->kind >= LINK_PRIMITIVES; i++)
        if (link->solids[i] >= 0)
            note_kinds(chain, link->solids[i]);
}

void chain_random(Chain *chain, const Recipe *recipe, Random *random, Refusals *refusals)
{
    *chain        = (Chain){.count = 0};
    int csg_nodes = recipe->csg_nodes ? random_below(random, recipe->csg_nodes + 1) : 0;
    int root      = random_solid(chain, recipe, csg_nodes, random, refusals);
    chain->root   = root;
    note_kinds(chain, root);
}
