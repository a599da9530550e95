#pragma once

#include "../common/Scores.h"

#include <rabit/RabitManager.h>

#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "bench.idl.h"
#include "gateway.idl.h"

namespace Rabit::Bench
{

using ::Bench::Sample;

// The managers that a user would write: each is woken by incoming messages and answers in its unit of work.
// They know names alone; the code that makes them decides whether a name is local or another node's.

// The names of the messages or queues of a pair of managers.
struct Names
{
    std::string In;
    std::string Out;
};

// Sends and receives Bench::Sample either as a mirrored message or through queues.
class SampleManager : public RabitManager
{
public:
    SampleManager(const std::string &name, const BenchOptions &options, const Names &names);

protected:
    // Returns the next sample that came in, or null if there is none. Valid until the next call.
    const Sample *Take();
    // Returns false if the queue refused the sample.
    bool Send(std::uint64_t number, std::int64_t sentAt,
              std::shared_ptr<RabitQueueReceipt> receipt = nullptr);
    // Sends back the sample that Take returned last.
    void SendBack();

    const BenchOptions Options;

private:
    const Names _names;
    std::shared_ptr<Sample> _out = std::make_shared<Sample>();
    std::shared_ptr<Sample> _in = std::make_shared<Sample>();
    std::shared_ptr<RabitQueue> _queue;
    std::shared_ptr<RabitMessage> _taken;
};

class PingManager final : public SampleManager
{
public:
    PingManager(const BenchOptions &options, const Names &names);
    void ExecuteUnitOfWork() override;

private:
    void Ask(std::uint64_t number);
    void CountAnswer(const Sample &answer);

    PingScore _score;
    std::uint64_t _asked = 0;
    std::int64_t _askedAt = 0;
};

class PongManager final : public SampleManager
{
public:
    PongManager(const BenchOptions &options, const Names &names);
    void ExecuteUnitOfWork() override;

private:
    ReceiverScore _score;
};

// Fills a queue as fast as it is emptied: receipts tell how much is on its way.
class SourceManager final : public SampleManager
{
public:
    SourceManager(const BenchOptions &options, const Names &names);
    void ExecuteUnitOfWork() override;

private:
    void ForgetSettled();
    bool MaySend() const;
    void SendOne();

    SourceScore _score;
    std::uint64_t _next = 0;
    std::uint64_t _settled = 0;  // messages before this one have an outcome
    std::uint64_t _mostUnderWay;
    std::uint64_t _receiptEvery;
    std::deque<std::pair<std::uint64_t, std::shared_ptr<RabitQueueReceipt>>> _receipts;
    bool _complete = false;
};

// Posts a message at a fixed rate.
class PacedManager final : public SampleManager
{
public:
    PacedManager(const BenchOptions &options, const Names &names);
    void ExecuteUnitOfWork() override;

private:
    SourceScore _score;
    std::shared_ptr<Gateway::Fleet> _fleet = std::make_shared<Gateway::Fleet>();
    std::int64_t _begin = 0;
    std::uint64_t _sent = 0;
    bool _complete = false;
};

class SinkManager final : public SampleManager
{
public:
    SinkManager(const BenchOptions &options, const Names &names);
    void ExecuteUnitOfWork() override;

private:
    ReceiverScore _score;
};

// Reports when the first message came.
class JoinManager final : public SampleManager
{
public:
    JoinManager(const BenchOptions &options, const Names &names);
    void ExecuteUnitOfWork() override;
};

}  // namespace Rabit::Bench
