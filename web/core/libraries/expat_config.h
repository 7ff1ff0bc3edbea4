/* expat_config.h: how expat is built for pages. */
#define BYTEORDER         1234
#define XML_STATIC        1
#define XML_GE            1
#define XML_CONTEXT_BYTES 1024
#define XML_MIN_SIZE      1
/* Names of attributes are in tables whose order nobody can see. */
#define XML_POOR_ENTROPY 1
