#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include "gateway.idl.h"

namespace Rabit::LinkWire
{

// The small messages of the queue links as IDL samples and back; for LinkData see LinkDataCodec.h. Into a
// sample: copies, reusing what memory the sample has. Out of a sample: views into it, valid as long as it is
// unchanged.
void ToSample(const LinkAck &ack, Gateway::LinkAckSample &sample);
void ToSample(const LinkHello &hello, Gateway::LinkHelloSample &sample);

void FromSample(const Gateway::LinkAckSample &sample, LinkAck &ack);
void FromSample(const Gateway::LinkHelloSample &sample, LinkHello &hello);

}  // namespace Rabit::LinkWire
