/*
 * fillet.h: unions whose CSG nodes are rounded and never swell: `kind: "fillet"` (math.md, section 4).
 */
#ifndef KRS_FILLET_H
#define KRS_FILLET_H

#include "compiler/eval/elaborate.h"

/* Makes the union of shapes, all solids or all figures, with fillets of the blend's width in
   between; NULL: reported, or nothing that a loop has in common. */
const Shape *make_fillet(Elaboration *e, const Call *call, const Shape *const *shapes,
                         uint32_t count, Blend blend);

#endif
