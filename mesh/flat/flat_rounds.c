/* flat_rounds.c: counts the sides of polygons that approximate circles. */
#include "mesh/flat/flat_rounds.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/base/minmax.h"

/* A multiple of four. */
enum { FEWEST_SIDES = 8, MAX_SIDES = 4096 };

static const double PI = 3.14159265358979323846;

/* The part of the error that sides take first, which leaves some for edges, where faces are farther
   from the surface; and the least part. */
static const double LARGEST_PART = 0.85, MIN_PART = 0.04;

/*
 * A side between two corners that are w outside of a unit circle comes within it by a^2 / 8 - w,
 * where a is its angle; one between such a corner and one on the circle by (a^2 / 2 - w)^2 / (2
 * a^2).  That is w as well if w = (3 - sqrt(8)) a^2 / 2.
 */
double flat_corner_radius(uint32_t sides)
{
    double angle = 2 * PI / sides;
    return sides > 4 ? 1 + 0.5 * (3 - sqrt(8)) * angle * angle : 1;
}

/* Returns the lesser distance from the origin to the line through (1, 0) and (wide cos angle, wide
   sin angle), and to that through two corners of radius `wide`. */
double flat_side_distance(uint32_t sides, double wide)
{
    double angle = 2 * PI / sides, across = wide * real_sin(angle),
           along = wide * real_cos(angle) - 1;
    return min2(across / real_hypot(across, along), wide * real_cos(0.5 * angle));
}

static double off_of(uint32_t sides)
{
    double wide = flat_corner_radius(sides);
    return max2(wide - 1, 1 - flat_side_distance(sides, wide));
}

static double stretch_of(uint32_t sides)
{
    double wide = flat_corner_radius(sides);
    return max2(wide, 1 / flat_side_distance(sides, wide));
}

FlatRounds flat_rounds_new(double error, Arena *arena)
{
    return (FlatRounds){
        .arena = arena, .numbers = {.arena = arena}, .error = error, .stretch = 1, .longest = 1};
}

static NumberKey key_of_kin(uint32_t kin) { return (NumberKey){kin, 0}; }

static NumberKey key_of_table(uint32_t table) { return (NumberKey){table, 1}; }

static NumberKey key_of_instance(const LaneStep *step)
{
    return (NumberKey){step->kin, 1 + (uint64_t)step->instance};
}

/* Returns the number of the round of a key; one that is new is like that of a number, or, with
   NO_NUMBER, like itself. */
static uint32_t take_round(FlatRounds *rounds, NumberKey key, uint32_t like)
{
    uint32_t fresh  = (uint32_t)rounds->list.count;
    uint32_t number = numbering_take(&rounds->numbers, key, fresh);
    if (number == fresh)
        array_push_large(
            rounds->arena, &rounds->list,
            ((FlatRound){.part = LARGEST_PART, .like = like == NO_NUMBER ? fresh : like}));
    return number;
}

static void blame(FlatRounds *rounds, uint32_t number)
{
    if (rounds->blame && number != NO_NUMBER)
        rounds->list.items[number].blamed = true;
}

static void widen(FlatRounds *rounds, uint32_t number, double radius, bool shared)
{
    FlatRound *round = &rounds->list.items[number];
    round->radius    = max2(round->radius, radius);
    round->shared |= shared;
}

/* Returns the number of what was noted of a step: of its instance, or else of all that are kin. */
static uint32_t number_of_step(const FlatRounds *rounds, const LaneStep *step)
{
    uint32_t own = step->instance ? numbering_find(&rounds->numbers, key_of_instance(step))
                                  : NO_NUMBER;
    return own != NO_NUMBER ? own : numbering_find(&rounds->numbers, key_of_kin(step->kin));
}

void flat_rounds_note(FlatRounds *rounds, const LaneStep *step, double radius, bool shared)
{
    if (rounds->counted) {
        blame(rounds, number_of_step(rounds, step));
        return;
    }
    uint32_t kin = take_round(rounds, key_of_kin(step->kin), NO_NUMBER);
    widen(rounds, kin, radius, shared);
    if (step->instance)
        take_round(rounds, key_of_instance(step), kin);
}

void flat_rounds_note_curves(FlatRounds *rounds, uint32_t table, double length, bool shared)
{
    if (rounds->counted) {
        blame(rounds, numbering_find(&rounds->numbers, key_of_table(table)));
        return;
    }
    uint32_t number = take_round(rounds, key_of_table(table), NO_NUMBER);
    widen(rounds, number, length, shared);
    rounds->list.items[number].curves = true;
}

/* Returns the part of the error that a round may take, over its radius. */
static double part_of(const FlatRounds *rounds, const FlatRound *round)
{
    const FlatRound *like = &rounds->list.items[round->like];
    return rounds->error * round->part * (like->shared ? 0.45 : 1) / like->radius;
}

static uint32_t sides_of(const FlatRounds *rounds, const FlatRound *round)
{
    double   part  = part_of(rounds, round);
    double   about = 2 * PI * sqrt(0.5 * (3 - sqrt(8)) / part);
    uint32_t sides = 4 * (uint32_t)(min2(max2(about, FEWEST_SIDES), MAX_SIDES) / 4);
    while (sides < MAX_SIDES && off_of(sides) > part)
        sides += 4;
    return sides;
}

static void count_sides(FlatRounds *rounds, FlatRound *round)
{
    bool shared     = rounds->list.items[round->like].shared;
    round->sides    = sides_of(rounds, round);
    double stretch  = stretch_of(round->sides);
    rounds->stretch = max2(rounds->stretch, stretch);
    rounds->longest = max2(rounds->longest, shared ? stretch * stretch * stretch : stretch);
}

void flat_rounds_count(FlatRounds *rounds)
{
    rounds->counted = true;
    rounds->stretch = rounds->longest = 1;
    rounds->chords                    = 0;
    for (size_t i = 0; i < rounds->list.count; i++) {
        FlatRound *round = &rounds->list.items[i];
        if (round->curves) {
            round->chord   = part_of(rounds, round);
            rounds->chords = max2(rounds->chords, round->chord);
        } else
            count_sides(rounds, round);
    }
}

uint32_t flat_rounds_sides(const FlatRounds *rounds, const LaneStep *step)
{
    uint32_t number = rounds->counted ? number_of_step(rounds, step) : NO_NUMBER;
    if (!rounds->counted)
        return FEWEST_SIDES;
    return number == NO_NUMBER ? 0 : rounds->list.items[number].sides;
}

double flat_rounds_radius(const FlatRounds *rounds, uint32_t kin)
{
    uint32_t number = numbering_find(&rounds->numbers, key_of_kin(kin));
    return number == NO_NUMBER ? 0 : rounds->list.items[number].radius;
}

double flat_rounds_chord(const FlatRounds *rounds, uint32_t table)
{
    uint32_t number = numbering_find(&rounds->numbers, key_of_table(table));
    return rounds->counted && number != NO_NUMBER ? rounds->list.items[number].chord : INFINITY;
}

/* Makes a round finer until it has more sides; returns false if it is fine enough. */
static bool make_finer(const FlatRounds *rounds, FlatRound *round)
{
    uint32_t sides = round->sides;
    bool     any   = false;
    while (round->part > MIN_PART && !(any && (round->curves || sides_of(rounds, round) > sides))) {
        round->part *= 0.8;
        any = true;
    }
    return any;
}

void flat_rounds_blame_kin(FlatRounds *rounds)
{
    for (size_t i = 0; i < rounds->list.count; i++)
        rounds->list.items[rounds->list.items[i].like].blamed |= rounds->list.items[i].blamed;
    for (size_t i = 0; i < rounds->list.count; i++)
        rounds->list.items[i].blamed |= rounds->list.items[rounds->list.items[i].like].blamed;
}

bool flat_rounds_refine(FlatRounds *rounds)
{
    bool any = false;
    for (size_t i = 0; i < rounds->list.count; i++) {
        any |= rounds->list.items[i].blamed && make_finer(rounds, &rounds->list.items[i]);
        rounds->list.items[i].blamed = false;
    }
    flat_rounds_count(rounds);
    return any;
}

void flat_rounds_save(FlatRounds *rounds)
{
    for (size_t i = 0; i < rounds->list.count; i++)
        rounds->list.items[i].saved = rounds->list.items[i].part;
}

void flat_rounds_restore(FlatRounds *rounds)
{
    for (size_t i = 0; i < rounds->list.count; i++)
        rounds->list.items[i].part = rounds->list.items[i].saved;
    flat_rounds_count(rounds);
}

bool flat_rounds_has_curves(const FlatRounds *rounds) { return rounds->chords > 0; }

void flat_rounds_open(const FlatRounds *rounds, LaneRanges *ranges)
{
    ranges->stretch = rounds->stretch;
    ranges->longest = rounds->longest;
    ranges->chords  = rounds->chords;
}

void flat_rounds_close(LaneRanges *ranges)
{
    ranges->stretch = ranges->longest = 1;
    ranges->chords                    = 0;
}
