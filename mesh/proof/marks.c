/* marks.c: a grid of bits, with words along z. */
#include "mesh/proof/marks.h"

#include <math.h>
#include <string.h>

#include "compiler/base/minmax.h"

void marks_clear(Marks *marks)
{
    if (marks->any)
        memset(marks, 0, sizeof *marks);
}

/* Returns the bits of a word that are in the box. */
static uint64_t bits_of(const MarkBox *box, unsigned word)
{
    unsigned first = word * MARKS_IN_WORD, last = first + MARKS_IN_WORD - 1;
    uint64_t bits = UINT64_MAX;
    if (box->low[2] > first)
        bits &= UINT64_MAX << (box->low[2] - first);
    if (box->high[2] < last)
        bits &= UINT64_MAX >> (last - box->high[2]);
    return bits;
}

void marks_set(Marks *marks, const MarkBox *box)
{
    marks->any = true;
    for (unsigned x = box->low[0]; x <= box->high[0]; x++)
        for (unsigned y = box->low[1]; y <= box->high[1]; y++)
            for (unsigned z = box->low[2] / MARKS_IN_WORD; z <= box->high[2] / MARKS_IN_WORD; z++)
                marks->cells[x][y][z] |= bits_of(box, z);
}

bool marks_touch(const Marks *marks, const MarkBox *box)
{
    if (!marks->any || box->low[2] > box->high[2])
        return false;
    for (unsigned x = box->low[0]; x <= box->high[0]; x++)
        for (unsigned y = box->low[1]; y <= box->high[1]; y++)
            for (unsigned z = box->low[2] / MARKS_IN_WORD; z <= box->high[2] / MARKS_IN_WORD; z++)
                if (marks->cells[x][y][z] & bits_of(box, z))
                    return true;
    return false;
}

MarkBox mark_box_none(void) { return (MarkBox){{MARKS, MARKS, MARKS}, {0, 0, 0}}; }

void mark_box_add(const Tets *tets, const double low[3], const double high[3], MarkBox *box)
{
    double scale = MARKS / (tets->step * CUBE_STEPS);
    for (int k = 0; k < 3; k++) {
        double least = max2(0, floor((low[k] - tets->origin[k]) * scale));
        double most  = min2(MARKS - 1, floor((high[k] - tets->origin[k]) * scale));
        least        = min2(least, MARKS - 1);
        most         = max2(most, 0);
        box->low[k]  = (uint16_t)min2(box->low[k], least);
        box->high[k] = (uint16_t)max2(box->high[k], most);
    }
}
