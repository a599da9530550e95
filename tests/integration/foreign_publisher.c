/* A plain Cyclone DDS program that publishes on the topic Tick, which the ledger nodes read: in one domain
 * participant under their type's name with another content, in a second one under a type name of its own.
 * With `changing`, only in the first one, and after it has changed the user data of another writer twice: as DDS tells
 * of one endpoint after the other, whoever does not take the change does not hear of the writer either.
 * Usage: foreign_publisher DOMAIN [changing], until SIGTERM */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "foreign.h"
#include "plain_program.h"

static void ChangeAWriter(dds_entity_t participant)
{
    const dds_entity_t topic = Check(dds_create_topic(participant, &Foreign_Tick_desc, "Whim", NULL, NULL), "topic");
    const dds_entity_t writer = Check(dds_create_writer(participant, topic, NULL, NULL), "writer");
    for (int i = 0; i < 2; ++i)
    {
        /* Everybody has heard of it as it was. */
        dds_sleepfor(DDS_SECS(2));
        dds_qos_t *qos = dds_create_qos();
        dds_qset_userdata(qos, &i, sizeof i);
        Check(dds_set_qos(writer, qos), "set_qos");
        dds_delete_qos(qos);
    }
}

static dds_entity_t MakeWriter(dds_domainid_t domain, const dds_topic_descriptor_t *type, int changing)
{
    const dds_entity_t participant = Check(dds_create_participant(domain, NULL, NULL), "participant");
    if (changing)
    {
        ChangeAWriter(participant);
    }
    const dds_entity_t topic = Check(dds_create_topic(participant, type, "Tick", NULL, NULL), "topic");
    /* The partition of a node of its own; without one Fast DDS's readers of all nodes do not match. */
    const char *partitions[] = {"", "foreigner"};
    dds_qos_t *qos = dds_create_qos();
    dds_qset_partition(qos, 2, partitions);
    const dds_entity_t publisher = Check(dds_create_publisher(participant, qos, NULL), "publisher");
    dds_delete_qos(qos);
    return Check(dds_create_writer(publisher, topic, NULL, NULL), "writer");
}

int main(int argc, char **argv)
{
    const int changing = argc == 3 && strcmp(argv[2], "changing") == 0;
    if (argc != 2 && !changing)
    {
        fprintf(stderr, "usage: foreign_publisher DOMAIN [changing]\n");
        return 2;
    }
    EndBySignal();
    const dds_domainid_t domain = (dds_domainid_t)atoi(argv[1]);
    const dds_entity_t same = MakeWriter(domain, &Ledger_Tick_desc, changing);
    const dds_entity_t other = changing ? 0 : MakeWriter(domain, &Foreign_Tick_desc, 0);
    const Ledger_Tick tick = {1};
    const Foreign_Tick words = {"not a number"};
    while (!ended)
    {
        Check(dds_write(same, &tick), "write");
        if (!changing)
        {
            Check(dds_write(other, &words), "write");
        }
        dds_sleepfor(DDS_MSECS(100));
    }
    return 0;
}
