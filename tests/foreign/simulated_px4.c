/* A small PX4 behind its agent, as DDS sees it, in plain Cyclone DDS: says ten times a second where it is and how it does,
 * flies to where DO_REPOSITION sends it, and refuses what is below 450 m. Armed after `arm` on its standard input.
 * Usage: simulated_px4 DOMAIN, until SIGTERM */
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../integration/plain_program.h"
#include "VehicleAttitude.h"
#include "VehicleCommand.h"
#include "VehicleCommandAck.h"
#include "VehicleGlobalPosition.h"
#include "VehicleLocalPosition.h"
#include "VehicleStatus.h"

static const double Period = 0.1;
static const double LowestM = 450;
static const double MetresInDegree = 111320;

static dds_qos_t *Qos(dds_durability_kind_t durability)
{
    dds_qos_t *qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(qos, durability);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
    return qos;
}

static dds_entity_t Writer(dds_entity_t participant, const dds_topic_descriptor_t *type, const char *name)
{
    dds_qos_t *qos = Qos(DDS_DURABILITY_TRANSIENT_LOCAL);
    const dds_entity_t topic = Check(dds_create_topic(participant, type, name, NULL, NULL), "topic");
    const dds_entity_t writer = Check(dds_create_writer(participant, topic, qos, NULL), "writer");
    dds_delete_qos(qos);
    return writer;
}

struct Aircraft
{
    double latitude;
    double longitude;
    double altitude;
    double target[3];
    double speed;
    double north;
    int flies;
    int armed;
};

static void Obey(struct Aircraft *aircraft, const px4_msgs_msg_dds__VehicleCommand_ *command, dds_entity_t answers)
{
    px4_msgs_msg_dds__VehicleCommandAck_ answer;
    memset(&answer, 0, sizeof answer);
    answer.command = command->command;
    if (command->command != 192)
    {
        answer.result = 3; /* not supported */
    }
    else if (!aircraft->armed || command->param7 < LowestM)
    {
        answer.result = 2; /* denied */
    }
    else
    {
        aircraft->target[0] = command->param5;
        aircraft->target[1] = command->param6;
        aircraft->target[2] = (double)command->param7;
        aircraft->speed = (double)command->param1;
        aircraft->flies = 1;
    }
    printf("command %u %.4f %.4f %.0f from %u: %u\n", command->command, command->param5, command->param6,
           (double)command->param7, command->source_component, answer.result);
    Check(dds_write(answers, &answer), "write");
}

static void Move(struct Aircraft *aircraft)
{
    aircraft->north = 0;
    if (!aircraft->flies)
    {
        return;
    }
    const double north = (aircraft->target[0] - aircraft->latitude) * MetresInDegree;
    const double step = aircraft->speed * Period;
    aircraft->north = fabs(north) > step ? copysign(aircraft->speed, north) : 0;
    aircraft->latitude = fabs(north) > step ? aircraft->latitude + copysign(step, north) / MetresInDegree : aircraft->target[0];
    aircraft->longitude = aircraft->target[1];
    aircraft->altitude = aircraft->target[2];
}

int main(int argc, char **argv)
{
    if (argc != 2)
    {
        fprintf(stderr, "usage: simulated_px4 DOMAIN\n");
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    EndBySignal();
    fcntl(STDIN_FILENO, F_SETFL, O_NONBLOCK);
    const dds_entity_t participant = Check(dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL), "participant");
    const dds_entity_t statuses = Writer(participant, &px4_msgs_msg_dds__VehicleStatus__desc, "rt/fmu/out/vehicle_status");
    const dds_entity_t positions =
        Writer(participant, &px4_msgs_msg_dds__VehicleGlobalPosition__desc, "rt/fmu/out/vehicle_global_position");
    const dds_entity_t locals =
        Writer(participant, &px4_msgs_msg_dds__VehicleLocalPosition__desc, "rt/fmu/out/vehicle_local_position");
    const dds_entity_t attitudes = Writer(participant, &px4_msgs_msg_dds__VehicleAttitude__desc, "rt/fmu/out/vehicle_attitude");
    const dds_entity_t answers =
        Writer(participant, &px4_msgs_msg_dds__VehicleCommandAck__desc, "rt/fmu/out/vehicle_command_ack");
    dds_qos_t *qos = Qos(DDS_DURABILITY_VOLATILE);
    const dds_entity_t topic =
        Check(dds_create_topic(participant, &px4_msgs_msg_dds__VehicleCommand__desc, "rt/fmu/in/vehicle_command", NULL, NULL), "topic");
    const dds_entity_t commands = Check(dds_create_reader(participant, topic, qos, NULL), "reader");
    dds_delete_qos(qos);

    struct Aircraft aircraft = {.latitude = 47.3977, .longitude = 8.5456, .altitude = 500};
    puts("ready");
    while (!ended)
    {
        char line[16];
        if (read(STDIN_FILENO, line, sizeof line) > 0)
        {
            aircraft.armed = 1;
        }
        void *samples[1] = {NULL};
        dds_sample_info_t info;
        while (dds_take(commands, samples, &info, 1, 1) == 1)
        {
            if (info.valid_data)
            {
                Obey(&aircraft, samples[0], answers);
            }
            dds_return_loan(commands, samples, 1);
            samples[0] = NULL;
        }
        Move(&aircraft);

        px4_msgs_msg_dds__VehicleStatus_ status;
        memset(&status, 0, sizeof status);
        status.arming_state = aircraft.armed ? 2 : 1;
        status.system_id = 1;
        status.component_id = 1;
        Check(dds_write(statuses, &status), "write");
        px4_msgs_msg_dds__VehicleLocalPosition_ local;
        memset(&local, 0, sizeof local);
        local.vx = (float)aircraft.north;
        Check(dds_write(locals, &local), "write");
        px4_msgs_msg_dds__VehicleAttitude_ attitude;
        memset(&attitude, 0, sizeof attitude);
        attitude.q[0] = 1;
        Check(dds_write(attitudes, &attitude), "write");
        px4_msgs_msg_dds__VehicleGlobalPosition_ position;
        memset(&position, 0, sizeof position);
        position.lat = aircraft.latitude;
        position.lon = aircraft.longitude;
        position.alt = (float)aircraft.altitude;
        position.lat_lon_valid = true;
        position.alt_valid = true;
        Check(dds_write(positions, &position), "write");
        dds_sleepfor(DDS_MSECS(100));
    }
    dds_delete(participant);
    return 0;
}
