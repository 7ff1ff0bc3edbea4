/*
 * svg.h: drawings, .svg.
 */
#ifndef KRS_IMPORT_SVG_H
#define KRS_IMPORT_SVG_H

#include "import/common/text.h"

bool import_svg(Import *import);

#endif
