/* A plain Cyclone DDS program, made from uav.idl by `idlc -l c` and knowing nothing of Rabit: reads the topic
 * Pose on the default partition and prints one line for each pose: `pose WRITER LATITUDE LONGITUDE ALTITUDE`.
 * Usage: plain_cyclone_subscriber DOMAIN SECONDS */
#include <dds/dds.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "uav.h"

enum
{
    MOST_AT_ONCE = 32
};

static void Check(dds_return_t result, const char *what)
{
    if (result < 0)
    {
        fprintf(stderr, "plain_cyclone_subscriber: %s: %s\n", what, dds_strretcode(-result));
        exit(1);
    }
}

static void PrintPoses(dds_entity_t reader)
{
    void *samples[MOST_AT_ONCE] = {NULL};
    dds_sample_info_t infos[MOST_AT_ONCE];
    const int32_t count = dds_take(reader, samples, infos, MOST_AT_ONCE, MOST_AT_ONCE);
    Check(count, "take");
    for (int32_t i = 0; i < count; ++i)
    {
        if (infos[i].valid_data)
        {
            const Uav_Pose *pose = samples[i];
            printf("pose %" PRIu64 " %.7f %.7f %.2f\n", infos[i].publication_handle, pose->latitude_deg,
                   pose->longitude_deg, pose->altitude_m);
        }
    }
    fflush(stdout);
    if (count > 0)
    {
        Check(dds_return_loan(reader, samples, count), "return loan");
    }
}

int main(int argc, char **argv)
{
    if (argc != 3)
    {
        fprintf(stderr, "usage: plain_cyclone_subscriber DOMAIN SECONDS\n");
        return 2;
    }
    const dds_entity_t participant = dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
    Check(participant, "participant");
    const dds_entity_t topic = dds_create_topic(participant, &Uav_Pose_desc, "Pose", NULL, NULL);
    Check(topic, "topic");
    const dds_entity_t reader = dds_create_reader(participant, topic, NULL, NULL);
    Check(reader, "reader");
    Check(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), "status mask");
    const dds_entity_t waitset = dds_create_waitset(participant);
    Check(waitset, "waitset");
    Check(dds_waitset_attach(waitset, reader, reader), "attach");

    const dds_time_t end = dds_time() + DDS_SECS(atoi(argv[2]));
    dds_attach_t triggered = 0;
    while (dds_time() < end)
    {
        Check(dds_waitset_wait_until(waitset, &triggered, 1, end), "wait");
        PrintPoses(reader);
    }
    Check(dds_delete(participant), "delete");
    return 0;
}
