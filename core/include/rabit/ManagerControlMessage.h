#pragma once

#include <rabit/RabitMessage.h>

#include <cstdint>
#include <memory>
#include <string>

namespace Rabit
{

// Tells managers what to do. Every manager listens to two of them: "ManagerControlMessage", which all
// managers share, and "<its name>:ManagerControlMessage".
class ManagerControlMessage : public RabitMessage
{
public:
    std::string ManagerName = "Unknown";
    // A change clears the manager's statistics.
    bool ResetMgrStatsToggle = false;
    // Seconds between two posts of the status message; 0 or less: none. The smaller of the two messages
    // counts.
    double PublishMgrStatsTime_Sec = 10.0;

    // Whether the manager is told to shut down.
    bool GetShutdownManager();
    void ShutdownManager(bool shutdown);

    std::unique_ptr<RabitMessage> Clone() const final;
    bool CopyMessage(RabitMessage *msg) final;
    // Restores the defaults.
    void Clear() final;
    std::string ToString() const final;
    // Big endian: header, ManagerName, shutdown, ResetMgrStatsToggle, PublishMgrStatsTime_Sec. Return the
    // bytes used; 0, and the message stays as it is, if the buffer is too small.
    int Serialize(std::uint8_t *buf, int maxBufSize, int stype = 0) override;
    int DeSerialize(std::uint8_t *buf, int len, int stype = 0) override;

private:
    bool _shutdownManager = false;
};

}  // namespace Rabit
