/*
 * refute_report.c: what is said of a distance or a claim that was refuted.
 */
#include "compiler/refute/refute_report.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/lower/research/research.h"
#include "compiler/refute/search.h"

static const char *point_text(Refuter *r, const double p[3])
{
    return diag_text(r->in->diags, "[%.6g, %.6g, %.6g]", p[0], p[1], p[2]);
}

static double distance3(const double a[3], const double b[3])
{
    return real_hypot(real_hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static const char *fault_text(Refuter *r, const Witness *w)
{
    switch (w->fault) {
    case FAULT_STEEP:
        return diag_text(r->in->diags, "it rises %.6g times as fast as it may", w->ratio);
    case FAULT_LONG:
        return diag_text(r->in->diags, "it is %.6g times as long as the way to the surface",
                         w->ratio);
    case FAULT_OUTSIDE: return "something of it is outside of its box";
    case FAULT_CONSTANT: return "a number in it that is the same at all points is not finite";
    case FAULT_BOX: return "a side of its box is not a number";
    case FAULT_CLAIM: /* report_claim */
    case FAULT_NAN:
    case FAULT_NONE: break;
    }
    return "it is not a number somewhere";
}

static bool has_point(const Witness *w)
{
    return w->fault != FAULT_CONSTANT && w->fault != FAULT_BOX;
}

static void note_points(Refuter *r, Diag *diag, const Witness *w)
{
    Diags      *diags = r->in->diags;
    const char *p     = point_text(r, w->p);
    if (w->fault == FAULT_STEEP || w->fault == FAULT_LONG)
        diag_note(diags, diag,
                  diag_text(diags, "the distance is %.6g at %s and %.6g at %s, %.6g apart", w->at_p,
                            p, w->at_q, point_text(r, w->q), distance3(w->p, w->q)));
    else if (has_point(w))
        diag_note(diags, diag, diag_text(diags, "the distance is %.6g at %s", w->at_p, p));
}

/* Notes "with r = 0.5, time = 2", unless there is no parameter. */
static void note_parameters(Refuter *r, Diag *diag, const NodeValue *parameters)
{
    const Scene *scene = r->in->scene;
    Text         text  = {.arena = r->in->arena};
    for (size_t i = 0; i < scene->parameters.count; i++) {
        const Parameter *parameter = &scene->parameters.items[i];
        text_format(&text, "%s%s = ", i ? ", " : "with ", parameter->name);
        for (uint32_t k = 0; k < parameter->components; k++)
            text_format(&text, "%s%.6g",
                        k                           ? ", "
                        : parameter->components > 1 ? "["
                                                    : "",
                        parameters[parameter->slot].v[k]);
        text_add(&text, parameter->components > 1 ? "]" : "");
    }
    text_format(&text, "%stime = %.6g", scene->parameters.count ? ", " : "at ", parameters[0].v[0]);
    diag_note(r->in->diags, diag, text.bytes);
}

/* Notes what the distance says is empty, and where the surface is all the same. */
static void note_surface(Refuter *r, Diag *diag, const Finding *finding)
{
    const Shape   *shape = r->suspects.items[finding->suspect].shape;
    const Witness *w     = &finding->witness;
    Search         search;
    double         surface[3];
    if (w->fault != FAULT_STEEP && w->fault != FAULT_LONG)
        return;
    Node          distance = lower_alone(r, shape, finding->lipschitz, NULL);
    const double *from     = fabs(w->at_p) >= fabs(w->at_q) ? w->p : w->q;
    double        said     = fmax(fabs(w->at_p), fabs(w->at_q));
    if (distance != NODE_NONE && search_of(r, shape, distance, false, &search) &&
        search_start(&search, finding->parameters) && search_surface(&search, from, surface))
        diag_note(r->in->diags, diag,
                  diag_text(r->in->diags,
                            "nothing is to be within %.6g of %s, but the surface is "
                            "at %s, %.6g away",
                            said, point_text(r, from), point_text(r, surface),
                            distance3(from, surface)));
    arena_free(r->in->scratch);
}

/* Notes the component that the shape is a part of, and the place in that where it shows. */
static void note_component(Refuter *r, Diag *diag, const Finding *whole, const Finding *finding)
{
    const Suspect   *suspect   = &r->suspects.items[finding->suspect];
    const Component *component = &r->in->scene->components.items[suspect->component];
    if (whole->suspect == finding->suspect && suspect->parent == SIZE_MAX)
        return;
    const char *text = diag_text(r->in->diags, "it is part of `%s`%s", component->name,
                                 has_point(&finding->witness) ? "; points are in its own space"
                                                              : "");
    if (r->suspects.items[whole->suspect].parent == SIZE_MAX && has_point(&whole->witness))
        text = diag_text(r->in->diags, "%s; there, %s is where it shows", text,
                         point_text(r, whole->witness.p));
    diag_note(r->in->diags, diag, text);
}

/* Marks the text where the author can do something: what is made in the library was asked for
   there. */
static void mark_caller(Refuter *r, Diag *diag, const Finding *finding)
{
    const Sources *sources = r->in->diags->sources;
    size_t         i       = finding->suspect;
    if (!sources->items[diag->span.source].library)
        return;
    while (i != SIZE_MAX && sources->items[r->suspects.items[i].shape->span.source].library)
        i = r->suspects.items[i].parent;
    if (i != SIZE_MAX)
        diag_secondary(r->in->diags, diag, r->suspects.items[i].shape->span, "for this");
}

static const char *const claim_texts[] = {
    [CLAIM_DISTANCE]                        = "distance",
    [CLAIM_GUARDED]                         = "distance that leaves out what is far",
    [CLAIM_ALONG]                           = "step along a ray (exact)",
    [CLAIM_RESEARCH + RESEARCH_TAYLOR]      = "step along a ray (taylor)",
    [CLAIM_RESEARCH + RESEARCH_ROOT_FREE]   = "step along a ray (root-free)",
    [CLAIM_RESEARCH + RESEARCH_DIRECTIONAL] = "step along a ray (directional)",
};

void report_finding(Refuter *r, const Finding *whole, const Finding *finding)
{
    const Shape *shape = r->suspects.items[finding->suspect].shape;
    Diags       *diags = r->in->diags;
    bool         claim = shape->kind == SHAPE_PRIMITIVE && (shape->exact || shape->claimed) &&
                 finding->claim == CLAIM_DISTANCE;
    Diag *diag  = diag_add(diags, DIAG_REFUTED, shape->span, "the %s of `%s` is refuted: %s",
                           claim_texts[finding->claim], shape->name,
                           fault_text(r, &finding->witness));
    diag->label = "this shape is to blame";
    if (claim && shape->distance != NODE_NONE)
        diag_secondary(diags, diag, r->graph->items[shape->distance].span,
                       shape->exact ? "`exact` is claimed of this"
                                    : "a `slope` is claimed of this");
    mark_caller(r, diag, finding);
    note_points(r, diag, &finding->witness);
    if (finding->claim == CLAIM_DISTANCE)
        note_surface(r, diag, finding);
    note_parameters(r, diag, finding->parameters);
    note_component(r, diag, whole, finding);
    if (finding->witness.fault == FAULT_OUTSIDE && shape->kind == SHAPE_PRIMITIVE)
        diag->help = "make its `within` larger";
    else if (claim)
        diag->help =
            shape->exact
                ? "claim a `slope` in place of `exact`, above what was found here; or leave "
                  "out both where the compiler can derive one"
                : "claim a larger `slope`, above what was found here; or leave it out where "
                  "the compiler can derive one";
    else if (shape->estimate)
        diag->help = "nothing is proven of an estimate, but none was ever found to be too long: "
                     "please report it";
    else
        diag->help = "nobody claimed this: it is a bug of krs, please report it";
}

void report_claim(Refuter *r, const Finding *finding)
{
    Diags            *diags = r->in->diags;
    const ShapeClaim *pair  = &finding->pair;
    Diag *diag  = diag_add(diags, DIAG_REFUTED, pair->shape->span, "`%s` of `%s` is refuted: %s",
                           pair->property, pair->shape->name, pair->wrong);
    diag->label = "this shape is to blame";
    diag_secondary(diags, diag, pair->span, "claimed here");
    mark_caller(r, diag, finding);
    diag_note(diags, diag,
              diag_text(diags, "by %.6g at %s", finding->witness.at_p,
                        point_text(r, finding->witness.p)));
    note_parameters(r, diag, finding->parameters);
    note_component(r, diag, finding, finding);
}
