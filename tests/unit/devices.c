/*
 * devices.c: devices are listed and chosen, and the validation layers speak when something is
 * wrong.
 */
#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "runtime/device/buffer.h"
#include "tests/support/device.h"
#include "tests/unit/tracer_fixture.h"

/* ---- The layers speak when something is wrong ---- */

static void copy_between(Gpu *gpu, const Buffer *from, const Buffer *to, bool with_barrier)
{
    double ms = 0;
    assert_true(gpu_begin(gpu));
    gpu_fill(gpu, from, 0, from->size, 7);
    if (with_barrier)
        gpu_barrier(gpu);
    gpu_copy(gpu, from, 0, to, 0, from->size);
    assert_true(gpu_finish(gpu, &ms));
}

static void a_planted_hazard_is_reported(void **state)
{
    (void)state;
    static Gpu gpu;
    Fixture    fixture = {0};
    Buffer     from, to;
    assert_true(gpu_open(&gpu,
                         &(KrsRendererOptions){.device             = tested_device(),
                                               .validation         = true,
                                               .validation_message = note_validation_message,
                                               .user               = &fixture},
                         0));
    assert_true(buffer_create(&gpu, &from, 1024, ON_DEVICE, "source"));
    assert_true(buffer_create(&gpu, &to, 1024, SHARED, "target"));

    copy_between(&gpu, &from, &to, true);
    assert_int_equal(fixture.validation_messages, 0);
    assert_int_equal(((uint32_t *)to.bytes)[255], 7);

    copy_between(&gpu, &from, &to, false); /* reads what may not be written yet */
    assert_true(fixture.validation_messages > 0);
    assert_non_null(strstr(fixture.validation_message, "SYNC-HAZARD-READ-AFTER-WRITE"));

    unsigned before = fixture.validation_messages;
    assert_true(gpu_begin(&gpu)); /* a copy beyond the end of the buffer */
    gpu_copy(&gpu, &from, 4096, &to, 0, 4);
    assert_true(fixture.validation_messages > before);
    assert_non_null(strstr(fixture.validation_message, "VUID-vkCmdCopyBuffer"));
    assert_int_equal(gpu.validation_messages, fixture.validation_messages);

    buffer_destroy(&gpu, &from);
    buffer_destroy(&gpu, &to);
    gpu_close(&gpu);
    assert_int_equal(gpu.memory_used, 0);
}

/* ---- Devices ---- */

static void devices_are_listed(void **state)
{
    (void)state;
    KrsDevice devices[16];
    size_t    count, preferred = 0, none;
    assert_int_equal(krs_devices(devices, 16, &count), KRS_OK);
    assert_in_range(count, 1, 16);
    for (size_t i = 0; i < count; i++) {
        assert_true(devices[i].name[0] != '\0');
        preferred += devices[i].preferred;
        assert_true(devices[i].usable || !devices[i].preferred);
    }
    assert_int_equal(preferred, 1);
    assert_int_equal(krs_devices(NULL, 0, &none), KRS_OK);
    assert_int_equal(none, count);
}

static KrsStatus open_named(const char *name, KrsDevice *device, char *message)
{
    KrsRenderer *renderer;
    KrsStatus    status = krs_renderer_new(&(KrsRendererOptions){.device = name}, &renderer);
    if (status == KRS_OK)
        *device = krs_renderer_device(renderer);
    snprintf(message, 512, "%s", krs_renderer_message(renderer));
    krs_renderer_free(renderer);
    return status;
}

static void devices_are_chosen(void **state)
{
    (void)state;
    KrsDevice devices[16], device;
    size_t    count;
    bool      cpu = false;
    char      message[512], word[32];
    assert_int_equal(krs_devices(devices, 16, &count), KRS_OK);
    assert_in_range(count, 1, 16);
    for (size_t i = 0; i < count; i++) {
        if (!devices[i].usable)
            continue;
        cpu |= devices[i].kind == KRS_DEVICE_CPU;
        snprintf(word, sizeof word, "%zu", i);
        assert_int_equal(open_named(word, &device, message), KRS_OK);
        assert_string_equal(device.name, devices[i].name);
        assert_string_equal(message, "");
        /* a part of the name, in another case */
        for (size_t k = 0; k < sizeof word; k++)
            word[k] = (char)toupper((unsigned char)devices[i].name[k]);
        word[8] = '\0';
        assert_int_equal(open_named(word, &device, message), KRS_OK);
        assert_int_equal(strncasecmp(device.name, word, strlen(word)), 0);
    }
    assert_int_equal(open_named("cpu", &device, message), cpu ? KRS_OK : KRS_NO_DEVICE);
    assert_true(!cpu || device.kind == KRS_DEVICE_CPU);

    assert_int_equal(open_named("99", &device, message), KRS_NO_DEVICE);
    assert_int_equal(open_named("no such card", &device, message), KRS_NO_DEVICE);
    assert_non_null(strstr(message, "no such card"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_planted_hazard_is_reported),
        cmocka_unit_test(devices_are_listed),
        cmocka_unit_test(devices_are_chosen),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    spirv_stop();
    return failed;
}
