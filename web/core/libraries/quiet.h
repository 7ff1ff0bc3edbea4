/* quiet.h: what Qhull would print, nobody reads (libqhull_r/userprintf_r.c). */
#include "libqhull_r/qhull_ra.h"

#define qh_fprintf(...) ((void)0)
#ifdef QHULL_USER /* user_r.c: of mistakes */
#define qh_printfacet(...)        ((void)0)
#define qh_printridge(...)        ((void)0)
#define qh_printvertex(...)       ((void)0)
#define qh_printneighborhood(...) ((void)0)
#define qh_printsummary(...)      ((void)0)
#define qh_printstats(...)        ((void)0)
#define qh_produce_output         qh_prepare_output
#endif
