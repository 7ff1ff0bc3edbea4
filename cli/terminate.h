/*
 * terminate.h: exceptions that nobody can catch.
 */
#ifndef KRS_TERMINATE_H
#define KRS_TERMINATE_H

#ifdef __cplusplus
extern "C" {
#endif

/* From now on want of memory in a library in C++ ends the process with KRS_OUT_OF_MEMORY and a line, also where its
   exception cannot be caught; others abort. */
void terminate_by_status(void);

#ifdef __cplusplus
}
#endif

#endif
