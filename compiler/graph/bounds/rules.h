/*
 * rules.h: what the rules of operations share.
 *
 * rules.c finds the rule of a row of ops.def; calculus.c is what rules are made of.
 */
#ifndef KRS_RULES_H
#define KRS_RULES_H

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/bounds/numbers.h"

/* An operation and the facts of its operands. */
typedef struct RuleInput {
    Op               op;
    GraphType        type;
    uint32_t         index; /* of OP_COMPONENT */
    const GraphType *types;
    const Fact      *operands;
    uint32_t         size; /* components of the result or the first operand, whichever has more */
} RuleInput;

/* The fact of the result. */
typedef Fact Rule(const RuleInput *input);

/* ---- calculus.c ---- */

/* One component with its gradient. */
typedef struct Jet {
    Range value, gradient[3];
} Jet;

Jet  jet_of(const Fact *fact, uint32_t i);
void fact_set(Fact *fact, uint32_t i, Jet jet);
Jet  jet_add(Jet a, Jet b);
Jet  jet_sub(Jet a, Jet b);
Jet  jet_mul(Jet a, Jet b);
Jet  jet_hull(Jet a, Jet b);
/* Returns the jet times a factor that is the same all over the box. */
Jet jet_times(Jet a, Range factor);
Jet jet_dot(const Fact *a, const Fact *b, uint32_t size);

/* Returns a fact of `size` components of which nothing is known; rules put in what they can say. */
Fact fact_unknown(uint32_t size);
/* Returns the range of the Euclidean length of a vector. */
Range length_range(const Range *sides, uint32_t size);
/* Returns a range with room for the rounding of a computation with numbers of this size. */
Range loosened(Range range, double scale);
/* Returns a component of the unit vector along a vector of this length. */
static inline Range unit_component(Range component, Range length)
{
    Range sides = {component.low < 0 ? -1 : 0, component.high > 0 ? 1 : 0};
    return length.low > 0 ? range_intersect(range_div(component, length), sides) : sides;
}
/* Tells whether the operands from `first` up to `count` are the same all over the box. */
bool operands_constant(const RuleInput *input, uint32_t first, uint32_t count);

/* Value and partial derivatives of one component. */
typedef struct Partials {
    Range value, by[MAX_OPERANDS];
} Partials;

/* Returns a MAP row: the operands weighted by partial derivatives, component by component. */
Fact fact_map(Norm norm, int arity, const Fact *operands, const Partials *rows, uint32_t size);
/* Joins both engines: the smaller slope counts, and no derivative is larger.  Ends out of order
   come from operands that are defined nowhere in the box. */
Fact fact_agreed(Fact fact, uint32_t size);

/* Returns a truth value of so many operands: 1, 0, or, where it may jump, both. */
Fact fact_of_truth(const RuleInput *input, uint32_t count, Range value);

/* Tells whether quotients by these ranges are numbers nowhere in the box: some divisor is 0. */
bool divides_by_zero(const Range *divisor, uint32_t size);

/* ---- rules of rows ---- */

/* Finds the range of the value alone, of `size` components, from those of the operands; NULL: the
   row has no RANGES. */
typedef void RangeRule(uint32_t size, Range *const *operands, Range *result);
RangeRule   *range_rule(Op op);
RangeRule    range_scale, range_cross, range_normalize;

/* rules_space.c */
Rule fact_rotate, fact_fold, fact_front, fact_cell, fact_cell_polar, fact_noise2, fact_noise3,
    fact_identity, fact_to_uint, fact_id_unit, fact_seeded, fact_seeded_direction, fact_julia,
    fact_mandelbulb, fact_trap, fact_of_table, fact_footprint;
/* rules_blends.c */
Rule fact_smin, fact_smin_endless, fact_smin_circular, fact_smin_chamfer, fact_smin_stairs,
    fact_blend_weight, fact_smin_shares, fact_blend_threshold;

#endif
