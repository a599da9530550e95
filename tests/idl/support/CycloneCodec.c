#include "CycloneCodec.h"

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <stdlib.h>
#include <string.h>

enum
{
    HeaderSize = 4,
    DomainId = 177,
    Xcdr1 = 1
};

// Only on the loopback interface: other processes must get nothing of this.
static const char *const Config =
    "<Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General></Domain>";

static dds_entity_t Participant(void)
{
    static dds_entity_t participant = 0;
    if (participant == 0)
    {
        dds_create_domain(DomainId, Config);
        participant = dds_create_participant(DomainId, NULL, NULL);
    }
    return participant;
}

void CycloneEncode(const dds_topic_descriptor_t *type, const void *value, CycloneBytes *result)
{
    result->size = 0;
    dds_qos_t *qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &representation);
    const dds_entity_t topic = dds_create_topic(Participant(), type, "sample", qos, NULL);
    const dds_entity_t reader = dds_create_reader(Participant(), topic, qos, NULL);
    const dds_entity_t writer = dds_create_writer(Participant(), topic, qos, NULL);
    struct ddsi_serdata *sample = NULL;
    dds_sample_info_t info;
    if (dds_write(writer, value) == DDS_RETCODE_OK &&
        dds_takecdr(reader, &sample, 1, &info, DDS_ANY_STATE) == 1)
    {
        const uint32_t size = ddsi_serdata_size(sample);
        struct ddsi_keyhash hash;
        ddsi_serdata_get_keyhash(sample, &hash, false);
        memcpy(result->keyHash, hash.value, sizeof result->keyHash);
        ddsi_serdata_get_keyhash(sample, &hash, true);
        memcpy(result->keyHashMd5, hash.value, sizeof result->keyHashMd5);
        if (size <= sizeof result->bytes)
        {
            ddsi_serdata_to_ser(sample, 0, size, result->bytes);
            result->size = size;
        }
        ddsi_serdata_unref(sample);
    }
    dds_delete(writer);
    dds_delete(reader);
    dds_delete(topic);
    dds_delete_qos(qos);
}

void CycloneEncodeBigEndian(const dds_topic_descriptor_t *type, const void *value, CycloneBytes *result)
{
    result->size = 0;
    dds_ostreamBE_t stream;
    dds_ostreamBE_init(&stream, 0, Xcdr1);
    if (dds_stream_writeBE(&stream, value, type->m_ops) != NULL &&
        stream.x.m_index <= sizeof result->bytes - HeaderSize)
    {
        memset(result->bytes, 0, HeaderSize);
        memcpy(result->bytes + HeaderSize, stream.x.m_buffer, stream.x.m_index);
        result->size = HeaderSize + stream.x.m_index;
    }
    dds_ostreamBE_fini(&stream);
}

void CycloneDecodeAndEncode(const dds_topic_descriptor_t *type, const uint8_t *bytes, size_t size,
                            CycloneBytes *result)
{
    result->size = 0;
    if (size < HeaderSize || bytes[0] != 0 || bytes[1] != 1)
    {
        return;
    }
    const uint32_t bodySize = (uint32_t)(size - HeaderSize);
    char *body = malloc(bodySize + 1);
    memcpy(body, bytes + HeaderSize, bodySize);
    uint32_t used = 0;
    if (dds_stream_normalize_data(body, &used, bodySize, false, Xcdr1, type->m_ops) != NULL)
    {
        dds_istream_t stream;
        dds_istream_init(&stream, bodySize, body, Xcdr1);
        void *value = calloc(1, type->m_size);
        dds_stream_read(&stream, value, type->m_ops);
        CycloneEncode(type, value, result);
        dds_stream_free_sample(value, type->m_ops);
        free(value);
    }
    free(body);
}
