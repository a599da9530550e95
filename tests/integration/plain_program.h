/* What the plain Cyclone DDS programs of the tests share. */
#pragma once

#include <dds/dds.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

/* Set once SIGTERM has come, after EndBySignal. */
static volatile sig_atomic_t ended = 0;

static void SetEnded(int number)
{
    (void)number;
    ended = 1;
}

static void EndBySignal(void)
{
    signal(SIGTERM, SetEnded);
}

/* The result, or the end of the program with a line that says what failed. */
static dds_entity_t Check(dds_entity_t result, const char *what)
{
    if (result < 0)
    {
        fprintf(stderr, "%s: %s\n", what, dds_strretcode(-result));
        exit(1);
    }
    return result;
}
