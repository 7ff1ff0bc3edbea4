/*
 * resources.h: whether a driver will get the threads and the memory that it needs.
 */
#ifndef KRS_RESOURCES_H
#define KRS_RESOURCES_H

#include <stdbool.h>

/* Tells how many of `wanted` threads can be there at the same time. */
unsigned threads_available(unsigned wanted);

/* Tells how many a driver that computes on the processor makes: for each core one for triangles and one
   for shaders, of up to 32 cores, and one for the queue. */
unsigned threads_of_software_device(void);

/* Tells whether there is as much memory as drivers take to start at all. */
bool memory_suffices_to_start(void);

#endif
