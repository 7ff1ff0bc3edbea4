/* flat_rounds.c: how many sides the polygons have that stand for circles. */
#include "compiler/mesh/flat_rounds.h"

#include <math.h>

#include "compiler/base/minmax.h"

/* A multiple of four. */
enum { FEWEST_SIDES = 12, MOST_SIDES = 4096 };

static const double PI = 3.14159265358979323846;

/* What is left over is for edges, at which faces are farther from the surface than beside them. */
static const double LARGEST_PART = 0.8, LEAST_PART = 0.04;

static double stretch_of(uint32_t sides) { return 1 / cos(PI / sides); }

FlatRounds flat_rounds_new(double error, Arena *arena)
{
    return (FlatRounds){
        .arena = arena, .numbers = {.arena = arena}, .error = error, .stretch = 1, .longest = 1};
}

void flat_rounds_note(FlatRounds *rounds, uint32_t kin, double radius, bool shared)
{
    NumberKey key   = {kin, 0};
    uint32_t  fresh = (uint32_t)rounds->list.count;
    if (rounds->counted) {
        if (rounds->blame)
            rounds->list.items[numbering_find(&rounds->numbers, key)].blamed = true;
        return;
    }
    uint32_t number = numbering_take(&rounds->numbers, key, fresh);
    if (number == fresh)
        array_push_large(rounds->arena, &rounds->list, (FlatRound){.part = LARGEST_PART});
    FlatRound *round = &rounds->list.items[number];
    round->radius    = max2(round->radius, radius);
    round->shared |= shared;
}

/* The middle of a side is radius (1 - cos(pi / sides)) from the circle. */
static uint32_t sides_of(const FlatRound *round, double error)
{
    double part  = error * round->part * (round->shared ? 0.45 : 1) / round->radius;
    double sides = part < 1 ? PI / acos(1 - part) : 0;
    sides        = 4 * ceil(sides / 4);
    return (uint32_t)min2(max2(sides, FEWEST_SIDES), MOST_SIDES);
}

void flat_rounds_count(FlatRounds *rounds)
{
    rounds->counted = true;
    rounds->stretch = rounds->longest = 1;
    for (size_t i = 0; i < rounds->list.count; i++) {
        FlatRound *round = &rounds->list.items[i];
        round->sides     = sides_of(round, rounds->error);
        double stretch   = stretch_of(round->sides);
        rounds->stretch  = max2(rounds->stretch, stretch);
        rounds->longest  = max2(rounds->longest,
                               round->shared ? stretch * stretch * stretch : stretch);
    }
}

uint32_t flat_rounds_sides(const FlatRounds *rounds, uint32_t kin)
{
    if (!rounds->counted)
        return FEWEST_SIDES;
    uint32_t number = numbering_find(&rounds->numbers, (NumberKey){kin, 0});
    return number == NO_NUMBER ? 0 : rounds->list.items[number].sides;
}

bool flat_rounds_refine(FlatRounds *rounds)
{
    bool any = false;
    for (size_t i = 0; i < rounds->list.count; i++) {
        FlatRound *round = &rounds->list.items[i];
        uint32_t   sides = round->sides;
        while (round->blamed && round->part > LEAST_PART &&
               sides_of(round, rounds->error) == sides) {
            round->part *= 0.6;
            any = true;
        }
        round->blamed = false;
    }
    flat_rounds_count(rounds);
    return any;
}

void flat_rounds_open(const FlatRounds *rounds, LaneRanges *ranges)
{
    ranges->unroll  = true;
    ranges->stretch = rounds->stretch;
    ranges->longest = rounds->longest;
}

void flat_rounds_close(LaneRanges *ranges)
{
    ranges->unroll  = false;
    ranges->stretch = ranges->longest = 1;
}
