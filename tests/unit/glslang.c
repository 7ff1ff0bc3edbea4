/*
 * Memory that runs out in glslang or SPIRV-Tools, at any allocation, ends that call, and nothing
 * else: other threads, and later calls, go on and make the same words.
 *
 * malloc is defined here, in front of the C library's, which `new` uses as well.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <glslang/build_info.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compiler/target/spirv.h"

/* ---- allocations that fail ---- */

extern void *__libc_malloc(size_t size);

static _Thread_local long allocations_left = -1; /* negative: all succeed */
static _Thread_local long allocations;
static _Thread_local bool lasting; /* those behind the first that fails fail, too */

/* Seen from outside, for the library of C++. */
__attribute__((visibility("default"))) void *malloc(size_t size)
{
    allocations++;
    if (allocations_left == 0) {
        if (!lasting)
            allocations_left = -1;
        return NULL;
    }
    allocations_left -= allocations_left > 0;
    return __libc_malloc(size);
}

/* ---- compiling ---- */

static const char text[] = "#version 440\n"
                           "layout(local_size_x = 8) in;\n"
                           "layout(std430, binding = 0) buffer Data { vec4 data[]; };\n"
                           "float bend(vec3 p, float by) { return sin(p.x * by) + length(p); }\n"
                           "void main() {\n"
                           "    uint i = gl_GlobalInvocationID.x;\n"
                           "    for (int k = 0; k < 4; k++)\n"
                           "        data[i].w += bend(data[i].xyz, float(k));\n"
                           "}\n";

static uint32_t *expected;
static size_t    expected_count;

/* One call, in which an allocation fails or none does. */
typedef struct Call {
    long      left;
    bool      lasting;
    long      made; /* allocations */
    KrsStatus status;
    bool      right; /* the words are as expected */
} Call;

static void *compile(void *user)
{
    Call     *call   = user;
    uint32_t *words  = NULL;
    size_t    count  = 0;
    char     *log    = NULL;
    allocations      = 0;
    lasting          = call->lasting;
    allocations_left = call->left;
    call->status     = spirv_compile(text, "test.comp", &words, &count, &log);
    allocations_left = -1;
    call->made       = allocations;
    call->right      = words && count == expected_count &&
                  memcmp(words, expected, count * sizeof *words) == 0;
    free(words);
    free(log);
    return NULL;
}

static int compile_once(void **state)
{
    char *log;
    (void)state;
    alarm(240); /* a lock that stays locked */
    return spirv_compile(text, "test.comp", &expected, &expected_count, &log) == KRS_OK ? 0 : -1;
}

static int forget(void **state)
{
    (void)state;
    free(expected);
    return 0;
}

/* In threads of their own, as a lock may be one's own to take twice. */
static void in_threads(Call *calls, int count)
{
    pthread_t threads[4];
    for (int i = 0; i < count; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, compile, &calls[i]), 0);
    for (int i = 0; i < count; i++)
        pthread_join(threads[i], NULL);
}

/* A call whose allocation number `failing` fails, others at the same time, and one afterwards. */
static void fail_at(long failing, bool lasting_failure)
{
    Call calls[3] = {{.left = failing, .lasting = lasting_failure}, {.left = -1}, {.left = -1}};
    Call after[2] = {{.left = -1}, {.left = -1}};
    in_threads(calls, 3);
    in_threads(after, 2);
    if (calls[0].status == KRS_OK)
        assert_true(calls[0].right); /* somebody could do without it, or had it */
    else
        assert_int_equal(calls[0].status, KRS_OUT_OF_MEMORY);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(calls[1 + i].status, KRS_OK);
        assert_true(calls[1 + i].right);
        assert_int_equal(after[i].status, KRS_OK);
        assert_true(after[i].right);
    }
}

/* Allocations of a call that starts glslang, or finds it started. */
static long count_allocations(void)
{
    Call call = {.left = -1};
    in_threads(&call, 1);
    assert_int_equal(call.status, KRS_OK);
    return call.made;
}

static void memory_runs_out_while_compiling(void **state)
{
    (void)state;
    enum { PLACES = 24 };
    spirv_start();
    count_allocations();
    long made = count_allocations();
    assert_true(made > PLACES);
    for (long i = 0; i < PLACES; i++)
        fail_at(i < 4 ? i : made * i / PLACES, i % 2);
    spirv_stop();
}

/* Every place is within the start of glslang, by the thread that comes first.  From version 14 on it keeps
   its lock then, so later calls are refused instead of waiting for ever. */
static void memory_runs_out_while_starting(void **state)
{
    (void)state;
    enum { PLACES = 24, STARTS_AGAIN = GLSLANG_VERSION_MAJOR < 14 };
    spirv_start();
    long starting = count_allocations(), made = count_allocations();
    spirv_stop();
    assert_true(starting > made + PLACES);
    for (long i = 0; i < PLACES; i++) {
        long failing = i < 8 ? i : (starting - made) * i / PLACES;
        Call call    = {.left = failing, .lasting = i % 2 == 1};
        Call after[] = {{.left = -1}, {.left = -1}};
        spirv_start();
        in_threads(&call, 1);
        assert_int_equal(call.status, KRS_OUT_OF_MEMORY);
        in_threads(after, 2);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(after[k].status, STARTS_AGAIN ? KRS_OK : KRS_OUT_OF_MEMORY);
            assert_int_equal(after[k].right, STARTS_AGAIN);
        }
        spirv_stop();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_runs_out_while_compiling),
        cmocka_unit_test(memory_runs_out_while_starting),
    };
    return cmocka_run_group_tests_name("glslang", tests, compile_once, forget);
}
