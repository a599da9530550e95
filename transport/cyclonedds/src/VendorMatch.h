/* Which reader of a participant a writer of the vendor's has matched. */
#pragma once

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity.h>
/* The next needs the one before. */
#include <dds/ddsi/ddsi_endpoint.h>
#include <dds/ddsi/ddsi_entity_match.h>

#include <stdbool.h>
#include <string.h>

static inline bool HasPrefixOf(const ddsi_guid_t *one, const ddsi_guid_t *other)
{
    return memcmp(&one->prefix, &other->prefix, sizeof one->prefix) == 0;
}

/* The reader of a participant that the writer has matched; NULL: none. Requires the writer's lock. */
static inline struct ddsi_wr_prd_match *FindMatch(const struct ddsi_writer *writer,
                                                  const ddsi_guid_t *participant)
{
    ddsrt_avl_iter_t at;
    struct ddsi_wr_prd_match *match = ddsrt_avl_iter_first(&ddsi_wr_readers_treedef, &writer->readers, &at);
    while (match != NULL && !HasPrefixOf(&match->prd_guid, participant))
    {
        match = ddsrt_avl_iter_next(&at);
    }
    return match;
}
