/*
 * few_threads.c: in front of the C library, allows a process FEW_THREADS threads.
 */
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>

typedef int Create(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                   void *user)
{
    static int  made;
    const char *most = getenv("FEW_THREADS");
    void       *next = dlsym(RTLD_NEXT, "pthread_create");
    if (!most || __atomic_fetch_add(&made, 1, __ATOMIC_RELAXED) >= atoi(most))
        return EAGAIN;
    return (*(Create **)&next)(thread, attributes, run, user);
}
