/*
 * outputs.h: what of outputs.c the entry of the sandbox needs.
 */
#ifndef KRS_CLI_SANDBOX_OUTPUTS_H
#define KRS_CLI_SANDBOX_OUTPUTS_H

#include <stdbool.h>

/* Closes all files of the child but the standard streams and the connection. */
bool outputs_close_others(void);

#endif
