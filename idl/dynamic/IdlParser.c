#include "dynamic/IdlParser.h"

#include <idl/processor.h>

#include <stdarg.h>
#include <stdio.h>

/* The parser reports errors to the standard error output, by functions that it calls through the dynamic
   linker. They are redefined here: an untrusted text must not write to our terminal, and its sender should be
   told the reason. Outside of RabitParseIdl they write like the parser's own. */
static _Thread_local char *CollectedReason;
static _Thread_local size_t CollectedSize;
static _Thread_local bool Collecting;

void idl_verror(const idl_pstate_t *pstate, const idl_location_t *loc, const char *fmt, va_list ap)
{
    char line[512];
    (void)pstate;
    int head = 0;
    if (loc && loc->first.file)
    {
        head = snprintf(line, 300, "%s:%u: ", loc->first.file->name, (unsigned)loc->first.line);
        head = head < 300 ? head : 299;
    }
    else if (loc)
    {
        head = snprintf(line, sizeof line, "line %u: ", (unsigned)loc->first.line);
    }
    vsnprintf(line + head, sizeof line - (size_t)head, fmt, ap);
    if (!Collecting)
    {
        fprintf(stderr, "%s\n", line);
    }
    else if (CollectedSize > 0 && CollectedReason[0] == '\0')
    {
        snprintf(CollectedReason, CollectedSize, "%s", line);
    }
}

void idl_error(const idl_pstate_t *pstate, const idl_location_t *loc, const char *fmt, ...)
{
    va_list ap;
    va_start(ap, fmt);
    idl_verror(pstate, loc, fmt, ap);
    va_end(ap);
}

void idl_warning(const idl_pstate_t *pstate, idl_warning_t warning, const idl_location_t *loc,
                 const char *fmt, ...)
{
    va_list ap;
    (void)warning;
    if (Collecting)
    {
        return;
    }
    va_start(ap, fmt);
    idl_verror(pstate, loc, fmt, ap);
    va_end(ap);
}

const void *RabitParseIdl(const char *text, bool isFile, char *reason, size_t reasonSize)
{
    idl_pstate_t *state = NULL;
    reason[0] = '\0';
    CollectedReason = reason;
    CollectedSize = reasonSize;
    Collecting = true;
    idl_retcode_t result = idl_create_pstate(IDL_FLAG_EXTENDED_DATA_TYPES | IDL_FLAG_ANONYMOUS_TYPES |
                                                 IDL_FLAG_ANNOTATIONS | IDL_FLAG_CASE_SENSITIVE,
                                             NULL, &state);
    if (result == IDL_RETCODE_OK)
    {
        state->config.default_extensibility = IDL_DEFAULT_EXTENSIBILITY_UNDEFINED;
        result = idl_parse_string(state, text);
        if (result != IDL_RETCODE_OK)
        {
            if (!isFile)
            {
                idl_delete_pstate(state);
            }
            state = NULL;
        }
    }
    Collecting = false;
    CollectedReason = NULL;
    return result == IDL_RETCODE_OK ? state : NULL;
}

void RabitFreeIdl(const void *state)
{
    idl_delete_pstate((idl_pstate_t *)state);
}
