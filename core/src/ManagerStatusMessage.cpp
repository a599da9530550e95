#include <rabit/ManagerStatusMessage.h>

#include <sstream>

namespace Rabit
{
namespace
{

const char *NameOf(ManagerStatusMessage::RunningState_e state)
{
    switch (state)
    {
        case ManagerStatusMessage::MgrState_Startup:
            return "Startup";
        case ManagerStatusMessage::MgrState_Running:
            return "Running";
        case ManagerStatusMessage::MgrState_Shutdown:
            return "Shutdown";
    }
    return "unknown";
}

// Visits the statistics in their order in the byte format.
template <typename Stats, typename IntField, typename DoubleField>
bool ForEachStat(Stats &stats, IntField intField, DoubleField doubleField)
{
    return intField(stats.TotalNumberOfExecuteCycles) || intField(stats.NumberOfExecuteCycles) ||
           doubleField(stats.TimeSinceLastStatsReset_Sec) ||
           doubleField(stats.MinExecuteUnitOfWorkTime_Sec) ||
           doubleField(stats.MaxExecuteUnitOfWorkTime_Sec) ||
           doubleField(stats.AveExecuteUnitOfWorkTime_Sec) ||
           doubleField(stats.TotalExecuteUnitOfWorkTime_Sec) || doubleField(stats.MinSleepTime_Sec) ||
           doubleField(stats.MaxSleepTime_Sec) || doubleField(stats.AveSleepTime_Sec) ||
           doubleField(stats.TotalSleepTime_Sec) || intField(stats.NumberOfWakeUpCallsWhileAsleep) ||
           intField(stats.NumberOfWakeUpCallsWhileAwake);
}

}  // namespace

std::unique_ptr<RabitMessage> ManagerStatusMessage::Clone() const
{
    return std::make_unique<ManagerStatusMessage>(*this);
}

bool ManagerStatusMessage::CopyMessage(RabitMessage *msg)
{
    const auto *other = dynamic_cast<const ManagerStatusMessage *>(msg);
    if (other == nullptr)
    {
        return false;
    }
    RabitMessage::CopyMessage(msg);
    ManagerName = other->ManagerName;
    RunningState = other->RunningState;
    ErrorCondition = other->ErrorCondition;
    ErrorCode = other->ErrorCode;
    ManagerStats = other->ManagerStats;
    Queues = other->Queues;
    return true;
}

void ManagerStatusMessage::Clear()
{
    RabitMessage::Clear();
    ErrorCondition = false;
    ErrorCode = 0;
    ManagerStats = ManagerStats_t();
    Queues.clear();
}

std::string ManagerStatusMessage::ToString() const
{
    std::ostringstream text;
    text << std::boolalpha << "ManagerName: " << ManagerName << "\n"
         << "RunningState: " << NameOf(RunningState) << "\n"
         << "ErrorCondition: " << ErrorCondition << "\n"
         << "ErrorCode: " << ErrorCode << "\n"
         << ManagerStats.ToString();
    for (const QueueStatus_t &queue : Queues)
    {
        text << "Queue " << queue.Name << ": " << queue.FillLevel << " of " << queue.Capacity
             << ", refused: " << queue.RefusedAdds << "\n";
    }
    return text.str();
}

int ManagerStatusMessage::Serialize(std::uint8_t *buf, int maxBufSize, int)
{
    ByteArrayWriter writer(buf, maxBufSize, Endian_Big);
    const bool failed = SerializeMsgHeader(writer) == 0 || writer.writeString(ManagerName) ||
                        writer.writeByte(static_cast<byte>(RunningState)) ||
                        writer.writeBool(ErrorCondition) || writer.writeInt32(ErrorCode) ||
                        ForEachStat(
                            ManagerStats, [&](int value) { return writer.writeInt32(value); },
                            [&](double value) { return writer.writeDouble(value); });
    return failed ? 0 : writer.Idx;
}

int ManagerStatusMessage::DeSerialize(std::uint8_t *buf, int len, int)
{
    ByteArrayReader reader(buf, len, Endian_Big);
    ManagerStatusMessage read(*this);
    constexpr int bytesAfterName = 1 + 1 + 4 + 4 * 4 + 9 * 8;
    if (read.DeSerializeMsgHeader(reader) == 0 || reader.readString(&read.ManagerName) ||
        reader.GetNumberBytesAvailable() < bytesAfterName)
    {
        return 0;
    }
    const byte state = reader.readByte();
    if (state > MgrState_Shutdown)
    {
        return 0;
    }
    read.RunningState = static_cast<RunningState_e>(state);
    read.ErrorCondition = reader.readBool();
    read.ErrorCode = reader.readInt32();
    ForEachStat(
        read.ManagerStats,
        [&](int &value)
        {
            value = reader.readInt32();
            return false;
        },
        [&](double &value)
        {
            value = reader.readDouble();
            return false;
        });
    *this = read;
    return reader.Idx;
}

}  // namespace Rabit
