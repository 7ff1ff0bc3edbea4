// terminate.cpp: exceptions that nobody can catch.
//
// Libraries in C++ may need memory where they give up what they have, or for objects that are made before main: an
// exception there ends the process, with KRS_OUT_OF_MEMORY and a line if it is want of memory.
#include <cstdlib>
#include <exception>
#include <new>
#include <unistd.h>

#include "krs/krs.h"

namespace
{

[[noreturn]] void end_process()
{
    static const char words[] = "krs: out of memory\n";
    try {
        std::exception_ptr thrown = std::current_exception();
        if (thrown)
            std::rethrow_exception(thrown);
    } catch (const std::bad_alloc &) {
        const ssize_t written = write(STDERR_FILENO, words, sizeof words - 1);
        (void)written; // there is nobody else to tell
        _exit(KRS_OUT_OF_MEMORY);
    } catch (...) {
    }
    std::abort();
}

/* Runs before objects of libraries are made that need memory, which is before main. */
__attribute__((constructor(101))) void set_end_of_process() { std::set_terminate(end_process); }

} // namespace
