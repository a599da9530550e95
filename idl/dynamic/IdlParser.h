/* Runs Cyclone DDS's IDL parser over a text in memory, for C++: its headers are C only. The caller must check
   untrusted texts first, as the parser is not made for them: see TextGuard.h. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* Parses a text that ends in zero and must outlive the state. Returns the state (const idl_pstate_t *,
       for IdlTree.h), to be given to RabitFreeIdl. If the text is refused, returns null and writes the
       parser's first error, ended by a zero, to reason. One call at a time: the parser does not promise to be
       thread-safe. `isFile`: the text has line markers with the names of files, which the reason names. What
       the parser allocated for a file that it refused is not freed, since it crashes while it cleans up after
       some ungrammatical texts. */
    const void *RabitParseIdl(const char *text, bool isFile, char *reason, size_t reasonSize);
    void RabitFreeIdl(const void *state);

#ifdef __cplusplus
}
#endif
