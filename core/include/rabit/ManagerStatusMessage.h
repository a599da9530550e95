#pragma once

#include <rabit/ManagerStats.h>
#include <rabit/RabitMessage.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace Rabit
{

// The state of a manager's queue when the status was posted.
struct QueueStatus_t
{
    std::string Name;
    int Capacity = 0;
    int FillLevel = 0;              // messages that waited in it
    std::uint64_t RefusedAdds = 0;  // messages refused because the queue was full, since it was made
};

// The status that a manager posts about itself as "<its name>:ManagerStatusMessage".
class ManagerStatusMessage : public RabitMessage
{
public:
    enum RunningState_e
    {
        MgrState_Startup,
        MgrState_Running,
        MgrState_Shutdown
    };

    // Values of ErrorCode: where an exception came from.
    enum ErrorCode_e
    {
        Error_None = 0,
        Error_ExecuteUnitOfWork = 1,  // cleared after the next unit of work that succeeds
        Error_Startup = 2,            // stays: the manager did not run
        Error_Shutdown = 3            // stays
    };

    std::string ManagerName = "Unknown";
    RunningState_e RunningState = MgrState_Startup;
    bool ErrorCondition = false;
    int ErrorCode = 0;
    ManagerStats_t ManagerStats;
    // The manager's own queue, then those that it registered, in that order.
    std::vector<QueueStatus_t> Queues;

    std::unique_ptr<RabitMessage> Clone() const final;
    bool CopyMessage(RabitMessage *msg) final;
    // Keeps the name and the state.
    void Clear() final;
    std::string ToString() const final;
    // Big endian: header, ManagerName, state (a byte), ErrorCondition, ErrorCode (int32), then the statistics
    // in the order of their declaration up to NumberOfWakeUpCallsWhileAwake; nothing of the queues. Return
    // the bytes used; 0, and the message stays as it is, if the buffer is too small or its contents
    // impossible.
    int Serialize(std::uint8_t *buf, int maxBufSize, int stype = 0) override;
    int DeSerialize(std::uint8_t *buf, int len, int stype = 0) override;
};

}  // namespace Rabit
