// Cyclone DDS's own encoder, for types that `idlc -l c` generated.
#pragma once

#include <dds/dds.h>

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    // A sample as Cyclone DDS puts it on the wire: encapsulation header, XCDR1, padding.
    typedef struct CycloneBytes
    {
        size_t size;  // 0: failed
        uint8_t bytes[16384];
        uint8_t keyHash[16];     // the key itself if this key fits into 16 bytes
        uint8_t keyHashMd5[16];  // MD5 of the key
    } CycloneBytes;

    // Writes the value to a topic inside this process and takes the sample's bytes and key hash from the
    // reader.
    void CycloneEncode(const dds_topic_descriptor_t *type, const void *value, CycloneBytes *result);
    // The same bytes big endian, by the stream writer alone; without key hash and padding.
    void CycloneEncodeBigEndian(const dds_topic_descriptor_t *type, const void *value, CycloneBytes *result);
    // Decodes a sample, and encodes what it found. size is 0 if Cyclone DDS refuses the sample.
    void CycloneDecodeAndEncode(const dds_topic_descriptor_t *type, const uint8_t *bytes, size_t size,
                                CycloneBytes *result);

#ifdef __cplusplus
}
#endif
