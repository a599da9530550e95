/* Cyclone DDS's IDL parser over a text in memory, for C++: its headers are C only. Where a text is from is
   the caller's care: the parser is not made for texts of strangers, see TextGuard.h. */
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* Parses a text that ends in zero and must outlive the state. Returns the state (const idl_pstate_t *,
       for IdlTree.h), to be given to RabitFreeIdl; null if it was refused, and then why, in the first of the
       parser's words, in reason, which is ended by a zero. One call at a time: the parser nowhere says that
       it may be used by several threads. */
    const void *RabitParseIdl(const char *text, char *reason, size_t reasonSize);
    void RabitFreeIdl(const void *state);

#ifdef __cplusplus
}
#endif
