// Values of the C types that `idlc -l c` generated, equal to those of Samples.h with the same name.
#pragma once

#include "CycloneCodec.h"

#ifdef __cplusplus
extern "C"
{
#endif

    typedef struct CycloneValue
    {
        const dds_topic_descriptor_t *type;
        const void *value;
    } CycloneValue;

    // Null type if there is none of that name. The value stays valid; one thread.
    CycloneValue CycloneValueNamed(const char *name);

#ifdef __cplusplus
}
#endif
