/* config-override.h: a text has the same glyphs everywhere, so HarfBuzz has all that shapes them. */
#undef HB_NO_OT_SHAPE_FRACTIONS
