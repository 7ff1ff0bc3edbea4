/*
 * resources.c: whether a driver will get the threads and the memory that it needs.
 *
 * Where the user or a container may have no more, lavapipe waits for ever for those that could not
 * be made.  So they are made once before, with the same stacks, and at the same time.
 */
#include "runtime/device/resources.h"

#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MAX_CORES = 32, MAX_THREADS = 2 * MAX_CORES + 1 };

/* Ends when the gate opens. */
static void *wait_at(void *gate)
{
    pthread_mutex_lock(gate);
    pthread_mutex_unlock(gate);
    return NULL;
}

unsigned threads_available(unsigned wanted)
{
    pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
    pthread_t       threads[MAX_THREADS];
    unsigned        count = 0;
    pthread_mutex_lock(&gate);
    while (count < wanted && count < MAX_THREADS &&
           pthread_create(&threads[count], NULL, wait_at, &gate) == 0)
        count++;
    pthread_mutex_unlock(&gate);
    for (unsigned i = 0; i < count; i++)
        pthread_join(threads[i], NULL);
    pthread_mutex_destroy(&gate);
    return count;
}

unsigned threads_of_software_device(void)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return 2 * (unsigned)(cores < 1 ? 1 : cores > MAX_CORES ? MAX_CORES : cores) + 1;
}

/* Tells whether memory suffices: lavapipe and its compiler take 200 MiB of addresses before
   anything is drawn. */
bool memory_suffices_to_start(void)
{
    const size_t bytes = (size_t)256 << 20;
    void *block = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (block == MAP_FAILED)
        return false;
    munmap(block, bytes);
    return true;
}
