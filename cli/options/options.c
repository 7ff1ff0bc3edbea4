/*
 * options.c: the tables of commands and options, and what is said about an option.
 */
#include "cli/options/options.h"

#include <stdio.h>
#include <string.h>

#include "compiler/base/text.h"

#define ON(command)     (1u << COMMAND_##command)
#define ON_ALL          ((1u << COMMAND_COUNT) - 1)
#define ON_PICTURES     (ON(RENDER) | ON(WATCH) | ON(FARM))
#define ON_SHOWN        (ON_PICTURES | ON(VIEW))
#define ON_LIT          (ON_SHOWN | ON(EXPORT))
#define ON_SCENE        (ON_SHOWN | ON(VALIDATE) | ON(QUERY))
#define ON_SOLID        (ON(MESH) | ON(SLICE) | ON(GRID) | ON(INFO))
#define ON_READING      (ON_ALL & ~(ON(DEVICES) | ON(EXPLAIN) | ON(HELP)))
#define ON_COMPILING    (ON_READING & ~(ON(IMPORT) | ON(MERGE) | ON(DENOISE)))
#define TEXT_OF(macro)  TEXT_OF_(macro)
#define TEXT_OF_(words) #words

const CommandInfo command_table[COMMAND_COUNT] = {
#define COMMAND(id, name, function, arguments, files, summary, examples) \
    [COMMAND_##id] = {name, arguments, files, summary, examples},
#include "cli/options/commands.def"
#undef COMMAND
};

CommandId find_command(const char *name)
{
    CommandId command = 0;
    while (command < COMMAND_COUNT && strcmp(name, command_table[command].name) != 0)
        command++;
    return command;
}

bool takes_scenes(CommandId command)
{
    const int files = command_table[command].files;
    return files != 0 && files != MAYBE_A_WORD && command != COMMAND_IMPORT &&
           command != COMMAND_MERGE && command != COMMAND_DENOISE;
}

const char *nearest_command(const char *name)
{
    const char *names[COMMAND_COUNT];
    for (CommandId command = 0; command < COMMAND_COUNT; command++)
        names[command] = command_table[command].name;
    return nearest_name(name, names, COMMAND_COUNT);
}

const char *const group_headings[GROUP_COUNT] = {
#define GROUP(id, heading) [GROUP_##id] = (heading),
#include "cli/options/option_groups.def"
#undef GROUP
};

const OptionInfo option_info[OPTION_COUNT] = {
#define NO_MEMBER                  ""
#define MEMBER(type, name, value)  ""
#define DEFAULT(type, name, value) " (default: " #value ")"
#define FLAG(member)               NULL, NULL
#define SWITCH(member, choices)    NULL, choices
#define CHOICE(member, choices)    NULL, choices
#define WORD(take, choices)        NULL, choices
#define LIST(take, choices, wants) wants, choices
#define VALUE(take, wants)         wants, NULL
#define OPTION(id, letter, name, argument, commands, group, member, value, help) \
    [OPTION_##id] = {letter, name, argument, commands, GROUP_##group, help member, value},
#include "cli/options/options.def"
};

bool option_belongs(OptionId id, CommandId command)
{
    return command < COMMAND_COUNT && (option_info[id].commands & (1u << command)) != 0;
}

bool group_belongs(OptionGroup group, CommandId command)
{
    OptionId id = 0;
    while (id < OPTION_COUNT && !(option_info[id].group == group && option_belongs(id, command)))
        id++;
    return id < OPTION_COUNT;
}

bool option_changes_pictures(OptionId id)
{
    switch (id) {
    case OPTION_CACHE:
    case OPTION_RESUME:
    case OPTION_SCHEDULE:
    case OPTION_SKIP_EXISTING:
    case OPTION_STATS: return false;
    default: return !option_belongs(id, COMMAND_CHECK); /* which makes no picture */
    }
}

static void add(char text[OPTION_TEXT], const char *words)
{
    size_t length = strlen(text);
    snprintf(text + length, OPTION_TEXT - length, "%s", words);
}

/* Adds the choices, in front of the last of which stands another word. */
static void add_choices(char text[OPTION_TEXT], const Choice *choices, const char *between,
                        const char *last)
{
    const char *waits = NULL, *before = "";
    for (; choices->name; choices++) {
        if (find_choice(choices->name, choices) != 0) /* it cannot be asked for */
            continue;
        if (waits) {
            add(text, before);
            add(text, waits);
            before = between;
        }
        waits = choices->name;
    }
    add(text, before[0] ? last : "");
    add(text, waits);
}

static const char *with_choices(const OptionInfo *option, const char *given, char text[OPTION_TEXT])
{
    const char *mark = strstr(given, "{}");
    text[0]          = '\0';
    if (!mark)
        return given;
    snprintf(text, OPTION_TEXT, "%.*s", (int)(mark - given), given);
    add_choices(text, option->choices, option->wants ? "," : ", ", option->wants ? "," : " or ");
    add(text, mark + 2);
    return text;
}

const char *option_argument(const OptionInfo *option, char text[OPTION_TEXT])
{
    text[0] = '\0';
    if (option->argument[0])
        return option->argument;
    add_choices(text, option->choices, "|", "|");
    return text;
}

const char *option_wants(const OptionInfo *option, char text[OPTION_TEXT])
{
    bool or_nothing = option->argument && option->argument[0] == '[';
    if (or_nothing) {
        with_choices(option, "{}", text);
        add(text, " or nothing");
        return text;
    }
    return with_choices(option, option->wants ? option->wants : "{}", text);
}

const char *option_help(const OptionInfo *option, char text[OPTION_TEXT])
{
    return with_choices(option, option->help, text);
}

const char *option_words(const OptionInfo *option, char text[OPTION_TEXT])
{
    text[0] = '\0';
    if (!option->choices || option->wants)
        return NULL;
    add_choices(text, option->choices, " ", " ");
    return text;
}
