/*
 * terminal.c: a terminal with a picture.
 */
#include "live/window/terminal.h"

#include <GLFW/glfw3.h>
#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "compiler/base/visible.h"
#include "live/window/cells.h"

/* Pixels of a cell where the terminal does not tell.  Characters are about twice as high as wide. */
enum { CELL_WIDTH = 8, CELL_HEIGHT = 16 };
/* Pixels of the picture for a character: chafa's symbols tell no finer detail. */
enum { SYMBOL_WIDTH = 4, SYMBOL_HEIGHT = 8 };
/* Rows below the picture. */
enum { LINES = 2 };

struct Terminal {
    struct termios before;
    int            woken; /* an eventfd */
    char           typed[64];
    size_t         count;
    bool           closed;
    bool           shows_pixels; /* not characters alone */
};

Terminal *terminal_open(const char **why)
{
    Terminal      *terminal = calloc(1, sizeof *terminal);
    struct termios raw;
    *why = !cells_exist() ? "krs was built without libchafa"
           : !terminal    ? "out of memory"
           : !isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)
               ? "standard input and output are no terminal"
               : NULL;
    if (*why || tcgetattr(STDIN_FILENO, &terminal->before) != 0) {
        *why = *why ? *why : strerror(errno);
        free(terminal);
        return NULL;
    }
    terminal->shows_pixels = cells_have_pixels();
    terminal->woken        = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    raw                    = terminal->before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO); /* Ctrl C stays a signal */
    raw.c_iflag &= ~(tcflag_t)(IXON | ICRNL);
    raw.c_cc[VMIN] = raw.c_cc[VTIME] = 0;
    raw.c_cc[VSUSP]                  = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    fputs("\033[?1049h\033[?25l\033[2J", stdout); /* another screen, without a cursor */
    fflush(stdout);
    return terminal;
}

void terminal_close(Terminal *terminal)
{
    if (!terminal)
        return;
    fputs("\033[0m\033[?25h\033[?1049l", stdout);
    fflush(stdout);
    tcsetattr(STDIN_FILENO, TCSANOW, &terminal->before);
    close(terminal->woken);
    free(terminal);
}

/* ---- keys ---- */

void terminal_wake(Terminal *terminal)
{
    const uint64_t one = 1;
    if (write(terminal->woken, &one, sizeof one) < 0)
        return; /* it is awake already */
}

void terminal_wait(Terminal *terminal, double seconds)
{
    struct pollfd events[2] = {{.fd = STDIN_FILENO, .events = POLLIN},
                               {.fd = terminal->woken, .events = POLLIN}};
    uint64_t      times;
    if (terminal->count == 0)
        poll(events, 2, (int)(1e3 * seconds));
    if (events[1].revents && read(terminal->woken, &times, sizeof times) < 0)
        return;
    const size_t  room = sizeof terminal->typed - terminal->count;
    const ssize_t got  = events[0].revents
                             ? read(STDIN_FILENO, terminal->typed + terminal->count, room)
                             : -1;
    if (got > 0)
        terminal->count += (size_t)got;
    else if (events[0].revents & (POLLHUP | POLLERR) || (got == 0 && room > 0))
        terminal->closed = true;
}

/* The texts that terminals send for keys without a letter, behind ESC; with modifiers `1;2` stands
   before the last character, or `;2` before the tilde. */
static const struct {
    const char *sent;
    int         key;
} specials[] = {{"[A", GLFW_KEY_UP},   {"[B", GLFW_KEY_DOWN}, {"[C", GLFW_KEY_RIGHT},
                {"[D", GLFW_KEY_LEFT}, {"OP", GLFW_KEY_F1},   {"[11~", GLFW_KEY_F1},
                {"[[A", GLFW_KEY_F1},  {"[24~", GLFW_KEY_F12}};

/* Takes the modifiers out of what was sent: shift is 1, alt 2, control 4, and one more. */
static int take_modifiers(char *sent)
{
    char *mark = strchr(sent, ';');
    if (!mark || mark[1] < '2' || mark[1] > '8')
        return 0;
    const int bits = mark[1] - '1';
    char     *from = mark[-1] == '1' && mark[-2] == '[' ? mark - 1 : mark;
    memmove(from, mark + 2, strlen(mark + 2) + 1);
    return (bits & 1 ? GLFW_MOD_SHIFT : 0) | (bits & 2 ? GLFW_MOD_ALT : 0) |
           (bits & 4 ? GLFW_MOD_CONTROL : 0);
}

/* Reads what begins with ESC; returns how many characters it has. */
static size_t read_escape(const char *typed, size_t count, int *key, int *modifiers)
{
    char   sent[16] = "";
    size_t length   = 1;
    *key            = GLFW_KEY_ESCAPE;
    if (count < 3 || (typed[1] != '[' && typed[1] != 'O'))
        return 1;
    for (length = 2; length < count && length < sizeof sent; length++)
        if ((typed[length] >= '@' && typed[length] <= '~') && !(length == 2 && typed[2] == '['))
            break;
    if (length == count || length == sizeof sent)
        return count;
    memcpy(sent, typed + 1, length);
    *modifiers = take_modifiers(sent);
    *key       = 0;
    for (size_t i = 0; i < sizeof specials / sizeof *specials; i++)
        if (strcmp(sent, specials[i].sent) == 0)
            *key = specials[i].key;
    return length + 1;
}

static void read_character(char typed, int *key, int *modifiers)
{
    static const struct {
        char typed;
        int  key;
    } others[] = {{'\t', GLFW_KEY_TAB},
                  {127, GLFW_KEY_BACKSPACE},
                  {8, GLFW_KEY_BACKSPACE},
                  {'+', GLFW_KEY_EQUAL},
                  {'?', GLFW_KEY_F1}};
    *key       = typed;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (others[i].typed == typed) {
            *key = others[i].key;
            return;
        }
    if (typed >= 'a' && typed <= 'z') {
        *key = typed - 'a' + GLFW_KEY_A;
    } else if (typed >= 'A' && typed <= 'Z') {
        *modifiers = GLFW_MOD_SHIFT;
    } else if (typed > 0 && typed < 27) {
        *key       = typed - 1 + GLFW_KEY_A;
        *modifiers = GLFW_MOD_CONTROL;
    }
}

bool terminal_key(Terminal *terminal, int *key, int *modifiers, bool *closed)
{
    size_t length = 1;
    *modifiers    = 0;
    *closed       = terminal->closed;
    if (terminal->count == 0)
        return false;
    if (terminal->typed[0] == '\033')
        length = read_escape(terminal->typed, terminal->count, key, modifiers);
    else
        read_character(terminal->typed[0], key, modifiers);
    terminal->count -= length;
    memmove(terminal->typed, terminal->typed + length, terminal->count);
    return true;
}

/* ---- pictures ---- */

typedef struct Grid {
    int columns, rows, cell_width, cell_height;
} Grid;

static Grid measure(void)
{
    struct winsize size = {0};
    Grid           grid = {80, 24, CELL_WIDTH, CELL_HEIGHT};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > LINES) {
        grid.columns = size.ws_col;
        grid.rows    = size.ws_row;
        if (size.ws_xpixel > 0 && size.ws_ypixel > 0) {
            grid.cell_width  = size.ws_xpixel / size.ws_col;
            grid.cell_height = size.ws_ypixel / size.ws_row;
        }
    }
    grid.rows -= LINES;
    return grid;
}

void terminal_size(const Terminal *terminal, uint32_t *width, uint32_t *height)
{
    const Grid grid   = measure();
    const bool pixels = terminal->shows_pixels;
    *width            = (uint32_t)(grid.columns * (pixels ? grid.cell_width : SYMBOL_WIDTH));
    *height           = (uint32_t)(grid.rows * (pixels ? grid.cell_height : SYMBOL_HEIGHT));
}

/* Prints the first line, as far as there is room for its characters. */
static void print_line(const char *line, uint32_t columns)
{
    uint32_t shown = 0;
    for (size_t left = strcspn(line, "\n"); left > 0;) {
        const Visible visible = visible_next(line, left);
        shown += visible.columns;
        if (shown > columns)
            break;
        fwrite(visible.text, 1, visible.length, stdout);
        line += visible.used;
        left -= visible.used;
    }
    fputs("\033[K", stdout);
}

void terminal_show(Terminal *terminal, const uint8_t *pixels, uint32_t width, uint32_t height,
                   const char *const *lines, size_t count)
{
    const Grid grid = measure();
    char      *text = pixels ? cells_print(pixels, width, height, grid.columns, grid.rows,
                                           grid.cell_width, grid.cell_height)
                             : NULL;
    (void)terminal;
    printf("\033[H%s\033[0m", text ? text : "\033[2J");
    for (size_t i = 0; i < count; i++) {
        const int row = grid.rows + LINES - (int)(count - i) + 1;
        if (row < 1)
            continue;
        printf("\033[%d;1H", row);
        print_line(lines[i], (uint32_t)grid.columns);
    }
    fflush(stdout);
    free(text);
}
