/* facing.c: divides pieces into parts that grow, each along one direction. */
#include "mesh/proof/facing.h"

#include <string.h>

#include "compiler/base/vec.h"

static const double ROUNDING = 1 + 1e-9;

/* Pieces by their numbers, a bit for each. */
typedef unsigned PieceSet;

/* Returns the least that a piece grows along a direction. */
static double growth(const FieldPieces *pieces, size_t i, const double direction[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        Range  by   = pieces->slopes[i].by[k];
        double step = pieces->signs[i] * direction[k];
        sum += min2(step * by.low, step * by.high);
    }
    return sum;
}

/* Searches for a direction in which all pieces of a set grow, from that of their mean, step by step
   towards the one that grows least; returns by how much all grow at least along the best one
   found. */
static double find_slope(const FieldPieces *pieces, PieceSet set, float found[3])
{
    enum { ROUNDS = 24 };
    double direction[3] = {0, 0, 0}, own[MAX_PIECES][3], best = 0;
    size_t members[MAX_PIECES], count = 0;
    for (size_t i = 0; i < pieces->count; i++) {
        if (!(set >> i & 1))
            continue;
        for (int k = 0; k < 3; k++)
            own[count][k] = pieces->signs[i] * 0.5 *
                            (pieces->slopes[i].by[k].low + pieces->slopes[i].by[k].high);
        if (!normalize3(own[count]))
            return 0;
        add_scaled3(direction, direction, 1, own[count]);
        members[count++] = i;
    }
    for (int round = 0; round < ROUNDS && normalize3(direction); round++) {
        double least = INFINITY;
        size_t worst = 0;
        for (size_t i = 0; i < count; i++) {
            double grows = growth(pieces, members[i], direction);
            if (grows < least) {
                least = grows;
                worst = i;
            }
        }
        for (int k = 0; k < 3 && least > best; k++)
            found[k] = (float)direction[k];
        best = max2(best, least);
        add_scaled3(direction, direction, 0.5 / (round + 1), own[worst]);
    }
    return best / ROUNDING;
}

/* Returns where the steps of the number begin that is complete before `end`. */
static size_t begin_of(const FieldPieces *pieces, size_t end)
{
    for (int missing = 1; missing > 0;)
        missing += pieces->steps[--end] < 0 ? 1 : -1;
    return end;
}

/* Adds the operands of a number that the last choice chooses from; false: they are too many. */
static bool add_operands(const FieldPieces *pieces, size_t end, Facing *facing)
{
    size_t begin = begin_of(pieces, end);
    if (pieces->steps[end - 1] == facing->choice)
        return add_operands(pieces, begin_of(pieces, end - 1), facing) &&
               add_operands(pieces, end - 1, facing);
    if (facing->operand_count == MAX_PIECES)
        return false;
    facing->begins[facing->operand_count] = begin;
    facing->ends[facing->operand_count++] = end;
    return true;
}

static PieceSet set_of_operand(const FieldPieces *pieces, const Facing *facing, size_t operand)
{
    PieceSet set = 0;
    for (size_t i = facing->begins[operand]; i < facing->ends[operand]; i++)
        if (pieces->steps[i] >= 0)
            set |= 1U << pieces->steps[i];
    return set;
}

/* Puts each operand into the first part with which it grows at least about as much as alone. */
static double find_parts(const FieldPieces *pieces, Facing *facing)
{
    static const double ABOUT = 0.5;
    PieceSet            sets[MAX_PIECES];
    double              slopes[MAX_PIECES], least = INFINITY;
    float               direction[3];
    size_t              count = 0;
    for (size_t i = 0; i < facing->operand_count; i++) {
        PieceSet own   = set_of_operand(pieces, facing, i);
        double   alone = find_slope(pieces, own, direction), slope = 0;
        size_t   part = 0;
        for (; part < count; part++) {
            slope = find_slope(pieces, sets[part] | own, direction);
            if (slope > ABOUT * min2(alone, slopes[part]))
                break;
        }
        sets[part]       = part == count ? own : sets[part] | own;
        slopes[part]     = part == count ? alone : slope;
        count            = part == count ? count + 1 : count;
        facing->parts[i] = part;
    }
    for (size_t i = 0; i < count; i++)
        least = min2(least, slopes[i]);
    return least;
}

double facing_find(const FieldPieces *pieces, float direction[3], Facing *facing)
{
    double slope          = find_slope(pieces, (1U << pieces->count) - 1, direction);
    facing->operand_count = 0;
    facing->choice        = pieces->steps[pieces->step_count - 1];
    if (slope > 0 || facing->choice >= 0 || !add_operands(pieces, pieces->step_count, facing))
        return slope;
    return find_parts(pieces, facing);
}
