/* A plain Cyclone DDS program, with types that Cyclone's own compiler made, that writes or reads topics as ROS 2 and PX4's
 * agent do. Writes a number each 50 ms, which rises by one; says `got TOPIC NUMBER` for each that it reads, and before the first
 * one `announced TOPIC TEXT`, the USER_DATA of its writer.
 * Usage: plain_cyclone DOMAIN write|read:TOPIC:string|setpoint:reliable|best_effort:volatile|transient_local..., until SIGTERM */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../integration/plain_program.h"
#include "wire.h"

enum { MOST = 16 };

struct Endpoint {
    int writes;
    char topic[128];
    int is_setpoint;
    int is_told; /* what its writer has announced */
    dds_entity_t entity;
};

static void Open(dds_entity_t participant, char *description, struct Endpoint *endpoint)
{
    const char *way = strtok(description, ":");
    const char *topic = strtok(NULL, ":");
    const char *type = strtok(NULL, ":");
    const char *reliability = strtok(NULL, ":");
    const char *durability = strtok(NULL, ":");
    if (durability == NULL)
    {
        fprintf(stderr, "plain_cyclone: not enough of a topic\n");
        exit(2);
    }
    endpoint->writes = strcmp(way, "write") == 0;
    snprintf(endpoint->topic, sizeof endpoint->topic, "%s", topic);
    endpoint->is_setpoint = strcmp(type, "setpoint") == 0;
    endpoint->is_told = 0;
    const dds_topic_descriptor_t *descriptor =
        endpoint->is_setpoint ? &px4_msgs_msg_dds__TrajectorySetpoint__desc : &std_msgs_msg_dds__String__desc;
    dds_qos_t *qos = dds_create_qos();
    dds_qset_reliability(qos, strcmp(reliability, "reliable") == 0 ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                         DDS_MSECS(100));
    dds_qset_durability(qos, strcmp(durability, "transient_local") == 0 ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                                        : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
    const dds_entity_t entity = Check(dds_create_topic(participant, descriptor, topic, NULL, NULL), "topic");
    endpoint->entity = endpoint->writes ? Check(dds_create_writer(participant, entity, qos, NULL), "writer")
                                        : Check(dds_create_reader(participant, entity, qos, NULL), "reader");
    dds_delete_qos(qos);
}

static void Write(const struct Endpoint *endpoint, unsigned long number)
{
    if (endpoint->is_setpoint)
    {
        px4_msgs_msg_dds__TrajectorySetpoint_ setpoint;
        memset(&setpoint, 0, sizeof setpoint);
        setpoint.timestamp = number;
        setpoint.position[2] = -5;
        dds_write(endpoint->entity, &setpoint);
        return;
    }
    char text[32];
    snprintf(text, sizeof text, "%lu", number);
    const std_msgs_msg_dds__String_ string = {text};
    dds_write(endpoint->entity, &string);
}

static void TellAnnounced(const struct Endpoint *endpoint, dds_instance_handle_t writer)
{
    dds_builtintopic_endpoint_t *announced = dds_get_matched_publication_data(endpoint->entity, writer);
    if (announced == NULL)
    {
        return;
    }
    void *data = NULL;
    size_t size = 0;
    if (dds_qget_userdata(announced->qos, &data, &size))
    {
        printf("announced %s %s\n", endpoint->topic, data == NULL ? "nothing" : (const char *)data);
        dds_free(data);
    }
    dds_builtintopic_free_endpoint(announced);
}

static void Read(struct Endpoint *endpoint)
{
    void *samples[1] = {NULL};
    dds_sample_info_t info;
    while (dds_take(endpoint->entity, samples, &info, 1, 1) == 1)
    {
        if (info.valid_data && !endpoint->is_told)
        {
            endpoint->is_told = 1;
            TellAnnounced(endpoint, info.publication_handle);
        }
        if (info.valid_data && endpoint->is_setpoint)
        {
            const px4_msgs_msg_dds__TrajectorySetpoint_ *setpoint = samples[0];
            printf("got %s %lu %g\n", endpoint->topic, (unsigned long)setpoint->timestamp, (double)setpoint->position[2]);
        }
        else if (info.valid_data)
        {
            printf("got %s %s\n", endpoint->topic, ((const std_msgs_msg_dds__String_ *)samples[0])->data);
        }
        dds_return_loan(endpoint->entity, samples, 1);
        samples[0] = NULL;
    }
}

int main(int argc, char **argv)
{
    if (argc < 3 || argc > 2 + MOST)
    {
        fprintf(stderr, "usage: plain_cyclone DOMAIN write|read:TOPIC:TYPE:RELIABILITY:DURABILITY...\n");
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    EndBySignal();
    const dds_entity_t participant = Check(dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL), "participant");
    struct Endpoint endpoints[MOST];
    for (int i = 2; i < argc; ++i)
    {
        Open(participant, argv[i], &endpoints[i - 2]);
    }
    puts("ready");
    for (unsigned long number = 1; !ended; ++number)
    {
        for (int i = 0; i < argc - 2; ++i)
        {
            if (endpoints[i].writes)
            {
                Write(&endpoints[i], number);
            }
            else
            {
                Read(&endpoints[i]);
            }
        }
        dds_sleepfor(DDS_MSECS(50));
    }
    dds_delete(participant);
    return 0;
}
