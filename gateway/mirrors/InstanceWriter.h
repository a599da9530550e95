#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace Rabit
{

// Writes the values of one message. A message has one value, so a type with a key has one instance at a time.
// After a value of another key was written, the former instance is disposed. This order leaves no reader
// without a value in between. A disposal that the network does not take is owed, and comes before the next
// value; so at most one is owed. A disposal that cannot be encoded is dropped; the transport logs and counts
// it. Not thread-safe.
class InstanceWriter
{
public:
    // The type must outlive the object.
    InstanceWriter(const MessageType &type, std::unique_ptr<TransportWriter> writer);

    // Ok if the value was written; TimedOut also if it was not tried because an owed disposal failed.
    WriteResult Write(const RabitMessage &message, std::int64_t sourceTime)
    {
        return Write(message, sourceTime, &TransportWriter::Write);
    }
    // The same with the first datagram alone (TransportWriter::WriteHeld). While others are held, a disposal
    // is owed.
    WriteResult WriteHeld(const RabitMessage &message, std::int64_t sourceTime)
    {
        return Write(message, sourceTime, &TransportWriter::WriteHeld);
    }
    // The same for a sample that is no value of the message: of any key, and no instance is disposed for it.
    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime)
    {
        return _writer->Write(sample, sourceTime);
    }
    WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime)
    {
        return _writer->WriteHeld(sample, sourceTime);
    }
    std::size_t HeldBytes() const { return _writer->HeldBytes(); }
    void SendHeld() { _writer->SendHeld(); }
    bool OwesDisposal() const { return !_former.empty(); }
    // Sends an owed disposal. Ok if none is owed.
    WriteResult DisposeFormer();
    int MatchedReaders() const { return _writer->MatchedReaders(); }
    int Destinations() const { return _writer->Destinations(); }

private:
    using Bytes = std::vector<std::uint8_t>;
    using Way = WriteResult (TransportWriter::*)(const SampleEncoder &, std::int64_t);

    WriteResult Write(const RabitMessage &message, std::int64_t sourceTime, Way way);

    const MessageType &_type;
    const std::unique_ptr<TransportWriter> _writer;
    // For a type with a key: the first sample of the present instance; empty before it is written.
    Bytes _present;
    KeyHash _presentKey{};
    Bytes _former;  // a sample of the instance that is to be disposed; empty: none
    std::int64_t _formerEnd = 0;
};

}  // namespace Rabit
