#pragma once

#include <rabit/ManagerStats.h>
#include <rabit/RabitMessage.h>

#include <cstdint>
#include <memory>
#include <string>

namespace Rabit
{

// What a manager tells about itself, as "<its name>:ManagerStatusMessage".
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

    std::unique_ptr<RabitMessage> Clone() const final;
    bool CopyMessage(RabitMessage *msg) final;
    // Keeps the name and the state.
    void Clear() final;
    std::string ToString() const final;
    // Big endian: header, ManagerName, state (a byte), ErrorCondition, ErrorCode (int32), then the statistics
    // in the order of their declaration up to NumberOfWakeUpCallsWhileAwake. Return the bytes used; 0, and
    // the message stays as it is, if the buffer is too small or its contents impossible.
    int Serialize(std::uint8_t *buf, int maxBufSize, int stype = 0) override;
    int DeSerialize(std::uint8_t *buf, int len, int stype = 0) override;
};

}  // namespace Rabit
