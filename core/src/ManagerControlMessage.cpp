#include <rabit/ManagerControlMessage.h>

#include <sstream>

namespace Rabit
{

bool ManagerControlMessage::GetShutdownManager()
{
    return _shutdownManager;
}

void ManagerControlMessage::ShutdownManager(bool shutdown)
{
    _shutdownManager = shutdown;
}

std::unique_ptr<RabitMessage> ManagerControlMessage::Clone() const
{
    return std::make_unique<ManagerControlMessage>(*this);
}

bool ManagerControlMessage::CopyMessage(RabitMessage *msg)
{
    const auto *other = dynamic_cast<const ManagerControlMessage *>(msg);
    if (other == nullptr)
    {
        return false;
    }
    RabitMessage::CopyMessage(msg);
    ManagerName = other->ManagerName;
    ResetMgrStatsToggle = other->ResetMgrStatsToggle;
    PublishMgrStatsTime_Sec = other->PublishMgrStatsTime_Sec;
    _shutdownManager = other->_shutdownManager;
    return true;
}

void ManagerControlMessage::Clear()
{
    const ManagerControlMessage defaults;
    RabitMessage::Clear();
    ManagerName = defaults.ManagerName;
    ResetMgrStatsToggle = defaults.ResetMgrStatsToggle;
    PublishMgrStatsTime_Sec = defaults.PublishMgrStatsTime_Sec;
    _shutdownManager = defaults._shutdownManager;
}

std::string ManagerControlMessage::ToString() const
{
    std::ostringstream text;
    text << std::boolalpha << "ManagerName: " << ManagerName << "\n"
         << "ShutdownManager: " << _shutdownManager << "\n"
         << "ResetMgrStatsToggle: " << ResetMgrStatsToggle << "\n"
         << "PublishMgrStatsTime_Sec: " << PublishMgrStatsTime_Sec << "\n";
    return text.str();
}

int ManagerControlMessage::Serialize(std::uint8_t *buf, int maxBufSize, int)
{
    ByteArrayWriter writer(buf, maxBufSize, Endian_Big);
    const bool failed = SerializeMsgHeader(writer) == 0 || writer.writeString(ManagerName) ||
                        writer.writeBool(_shutdownManager) || writer.writeBool(ResetMgrStatsToggle) ||
                        writer.writeDouble(PublishMgrStatsTime_Sec);
    return failed ? 0 : writer.Idx;
}

int ManagerControlMessage::DeSerialize(std::uint8_t *buf, int len, int)
{
    ByteArrayReader reader(buf, len, Endian_Big);
    ManagerControlMessage read(*this);
    constexpr int bytesAfterName = 1 + 1 + 8;
    if (read.DeSerializeMsgHeader(reader) == 0 || reader.readString(&read.ManagerName) ||
        reader.GetNumberBytesAvailable() < bytesAfterName)
    {
        return 0;
    }
    read._shutdownManager = reader.readBool();
    read.ResetMgrStatsToggle = reader.readBool();
    read.PublishMgrStatsTime_Sec = reader.readDouble();
    *this = read;
    return reader.Idx;
}

}  // namespace Rabit
