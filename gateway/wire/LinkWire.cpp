#include "wire/LinkWire.h"

#include <algorithm>

namespace Rabit::LinkWire
{

void ToSample(const LinkAck &ack, Gateway::LinkAckSample &sample)
{
    sample.version = ack.Version;
    sample.source.assign(ack.Source);
    sample.destination.assign(ack.Destination);
    sample.queue.assign(ack.Queue);
    sample.receiver_incarnation = ack.ReceiverIncarnation;
    sample.sender_incarnation = ack.SenderIncarnation;
    sample.cumulative = ack.Cumulative;
    std::copy(ack.Delivered.begin(), ack.Delivered.end(), sample.delivered.begin());
    std::copy(ack.Refused.begin(), ack.Refused.end(), sample.refused.begin());
    sample.credit = ack.Credit;
    sample.clock = ack.Clock;
    sample.time = ack.Time;
    sample.your_incarnation = ack.YourIncarnation;
    sample.echo_sent_at = ack.EchoSentAt;
    sample.echo_held_for = ack.EchoHeldFor;
}

void ToSample(const LinkHello &hello, Gateway::LinkHelloSample &sample)
{
    sample.version = hello.Version;
    sample.source.assign(hello.Source);
    sample.destination.assign(hello.Destination);
    sample.incarnation = hello.Incarnation;
    sample.your_incarnation = hello.YourIncarnation;
    sample.clock = hello.Clock;
    sample.time = hello.Time;
}

void FromSample(const Gateway::LinkAckSample &sample, LinkAck &ack)
{
    ack.Version = sample.version;
    ack.Source = sample.source;
    ack.Destination = sample.destination;
    ack.Queue = sample.queue;
    ack.ReceiverIncarnation = sample.receiver_incarnation;
    ack.SenderIncarnation = sample.sender_incarnation;
    ack.Cumulative = sample.cumulative;
    std::copy(sample.delivered.begin(), sample.delivered.end(), ack.Delivered.begin());
    std::copy(sample.refused.begin(), sample.refused.end(), ack.Refused.begin());
    ack.Credit = sample.credit;
    ack.Clock = sample.clock;
    ack.Time = sample.time;
    ack.YourIncarnation = sample.your_incarnation;
    ack.EchoSentAt = sample.echo_sent_at;
    ack.EchoHeldFor = sample.echo_held_for;
}

void FromSample(const Gateway::LinkHelloSample &sample, LinkHello &hello)
{
    hello.Version = sample.version;
    hello.Source = sample.source;
    hello.Destination = sample.destination;
    hello.Incarnation = sample.incarnation;
    hello.YourIncarnation = sample.your_incarnation;
    hello.Clock = sample.clock;
    hello.Time = sample.time;
}

}  // namespace Rabit::LinkWire
