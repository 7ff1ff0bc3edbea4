/*
 * main.c: `krs`, the command.
 *
 * The way of a command line: parse_options.c understands it, supervise.c forks, the function of the
 * subcommand does the work in the child, and the status it returns becomes the exit status.
 */
#include <OpenEXR/openexr.h>
#include <errno.h>
#include <fcntl.h>
#include <libdeflate.h>
#include <png.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include "cli/shell/commands.h"
#include "cli/shell/confine.h"
#include "cli/shell/console.h"
#include "cli/grid/gridding.h"
#include "cli/help.h"
#include "cli/shell/input.h"
#include "cli/parse_options.h"
#include "cli/shell/supervise.h"
#include "live/window/window.h"

static Work *const works[COMMAND_COUNT] = {
#define COMMAND(id, name, function, arguments, files, summary, examples) [COMMAND_##id] = function,
#include "cli/options/commands.def"
#undef COMMAND
};

/* A standard stream that the caller closed would otherwise be given out again, and a picture
   written into what printf takes for the terminal.  A folder can be neither read nor written, also by who opens
   it once more as /dev/stdout. */
static void hold_standard_streams(void)
{
    for (int stream = 0; stream < 3; stream++)
        if (fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            open("/", O_RDONLY | O_DIRECTORY);
}

static KrsStatus print_version(void)
{
    int         major, minor, patch;
    const char *extra;
    uint32_t    vulkan = VK_API_VERSION_1_0;
    exr_get_library_version(&major, &minor, &patch, &extra);
    vkEnumerateInstanceVersion(&vulkan);
    printf("krs %s%s%s%s\n", krs_version(), *commit ? " (" : "", commit, *commit ? ")" : "");
    printf("Vulkan loader %u.%u.%u\n", VK_API_VERSION_MAJOR(vulkan), VK_API_VERSION_MINOR(vulkan),
           VK_API_VERSION_PATCH(vulkan));
    printf("glslang %s\n", spirv_glslang_version());
    printf("SPIRV-Tools %s\n", spirv_tools_version());
    printf("OpenEXRCore %d.%d.%d%s\n", major, minor, patch, extra ? extra : "");
    printf("libdeflate %s\n", LIBDEFLATE_VERSION_STRING);
    printf("libpng %s\n", png_get_libpng_ver(NULL));
    return console_finish();
}

static int print_completion(const char *shell)
{
    if (completion_print(shell, stdout))
        return console_finish();
    say("there is completion for bash, zsh and fish, not for `%s`", shell);
    return KRS_BAD_ARGUMENT;
}

/* Prints pages of the manual or completions, for `make install`.  False: neither is asked for. */
static bool print_installed(int argc, char **argv, int *status)
{
    CommandId command = COMMAND_COUNT;
    if (argc >= 2 && argc <= 3 && strcmp(argv[1], "--completion") == 0) {
        *status = print_completion(argc == 3 ? argv[2] : "bash");
        return true;
    }
    if (argc < 2 || argc > 3 || strcmp(argv[1], "--manual") != 0)
        return false;
    if (argc == 3)
        command = find_command(argv[2]);
    if (argc == 3 && command == COMMAND_COUNT) {
        *status = say_no_command(argv[2]);
        return true;
    }
    manual_print(command, stdout);
    *status = console_finish();
    return true;
}

/* Opens what is needed in the sandbox and cannot be opened there: the display, and a library beside the program. */
static KrsStatus open_outside(const Options *options)
{
    const char *why    = "";
    KrsStatus   status = KRS_OK;
    if (!options->needs)
        return KRS_OK;
    if (options->command == COMMAND_VIEW && !options->terminal && !window_connect(&why)) {
        say("no window can be opened: %s", why);
        return KRS_NO_DEVICE;
    }
    for (size_t i = 0; i < options->outputs.count && status == KRS_OK; i++)
        if (options->command == COMMAND_GRID && grid_is_vdb(options->outputs.items[i]))
            status = grid_check_vdb(options->outputs.items[i]);
    return status;
}

/* Does the work of the child: out of memory in any arena of the command ends here. */
static KrsStatus work_with_memory(Options *options)
{
    jmp_buf exhausted;
    if (setjmp(exhausted) != 0) {
        say("out of memory");
        return KRS_OUT_OF_MEMORY;
    }
    options->arena->memory->exhausted = &exhausted;
    KrsStatus status                  = open_outside(options);
    if (status == KRS_OK)
        status = confine_enter(options);
    if (status == KRS_OK)
        status = packs_open(options);
    if (status == KRS_OK)
        status = works[options->command](options);
    if (status == KRS_NO_DEVICE && options->needs && options->command != COMMAND_VIEW)
        say("cards are not reached from the sandbox of untrusted scenes: install a device of the "
            "processor (mesa-vulkan-drivers), or give --untrusted=limits");
    return status;
}

static int run(Options *options, int argc, char **argv)
{
    jmp_buf exhausted;
    if (setjmp(exhausted) != 0) {
        say("out of memory");
        return KRS_OUT_OF_MEMORY;
    }
    options->arena->memory->exhausted = &exhausted;
    KrsStatus status                  = options_parse(options, argc, argv);
    if (status != KRS_OK)
        return status;
    if (options->help) {
        help_print_command(options->command, options->all, stdout);
        return console_finish();
    }
    if (options->untrusted)
        output_forbid_links();
    status = input_open(options);
    if (status == KRS_OK)
        status = confine_prepare(options);
    return status == KRS_OK ? supervise(options, work_with_memory) : (int)status;
}

static int map_exit(const Options *options, int status)
{
    for (size_t i = 0; i < options->exit_map.count; i++)
        if (options->exit_map.items[i].from == status)
            return options->exit_map.items[i].to;
    return status;
}

int main(int argc, char **argv)
{
    hold_standard_streams();
    signal(SIGPIPE, SIG_IGN); /* a write that fails says so by itself */
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGUSR1, SIG_IGN); /* supervise.h has what it means */
    if (argc == 2 && (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0))
        return print_version();
    int status;
    if (print_installed(argc, argv, &status))
        return status;
    Memory  memory  = {.limit = 0};
    Arena   arena   = {.memory = &memory};
    Options options = {.arena = &arena};
    status          = map_exit(&options, run(&options, argc, argv));
    arena_free(&arena);
    return status;
}
