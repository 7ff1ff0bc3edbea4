/*
 * threads.h: whether a driver will get the threads that it needs.
 */
#ifndef KRS_THREADS_H
#define KRS_THREADS_H

/* How many of `wanted` threads can be there at the same time. */
unsigned threads_available(unsigned wanted);

/* How many a driver that computes on the processor makes: for each core one for triangles and one
   for kernels, of up to 32 cores, and one for the queue. */
unsigned threads_of_software_device(void);

#endif
