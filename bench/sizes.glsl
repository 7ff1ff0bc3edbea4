/*
 * sizes.glsl: stand-ins for what the bench chooses.
 */
#define CHAINS      3 // of peak.comp
#define ITERATIONS  1024
#define EVALUATIONS 128 // of distance.comp
