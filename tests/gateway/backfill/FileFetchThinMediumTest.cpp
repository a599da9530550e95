// A file over queue links on a medium of 250 kbit/s, in virtual time: what the channel is used for, and what
// cuts and kills cost.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <random>

#include "ThinMedium.h"
#include "backfill/FileFetch.h"

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;
using Test::ThinMedium;

constexpr std::uint64_t FileSize = 10'000'000;

// The node `alpha` has the file, the program `beta` fetches it.
class Transfer
{
public:
    Transfer()
    {
        medium.BitsPerSecond = 250e3;
        medium.A.OnDelivery = [this](std::span<const std::uint8_t> payload)
        { AnswerTo(questions.at(NumberIn(payload))); };
        medium.B.OnDelivery = [this](std::span<const std::uint8_t> payload)
        { received += fetch->Answered(answers.at(NumberIn(payload)), medium.Now).size(); };
        medium.B.OnEnd = [this](std::uint64_t id, LinkOutcome outcome)
        {
            const auto sent = underWay.extract(id);
            if (!sent.empty() && outcome != LinkOutcome::Delivered)
            {
                fetch->Failed(sent.mapped(), medium.Now);
            }
        };
        Begin();
    }

    // Returns false if there was no progress for long.
    bool RunUntil(std::uint64_t bytes)
    {
        const LinkTime end = medium.Now + 2000s;
        while (received < bytes && medium.Now < end)
        {
            Run(100ms);
        }
        return received >= bytes;
    }
    void Run(LinkTime time)
    {
        for (const LinkTime end = medium.Now + time; medium.Now < end;)
        {
            fetch->SetNode(medium.A.Lives, !medium.Cut, medium.Now);
            for (const Question &question : fetch->Due(medium.Now))
            {
                questions[question.number] = question;
                underWay[Send(medium.B, "alpha", question.number, 60)] = question.number;
            }
            medium.Live(std::min<LinkTime>(20ms, end - medium.Now));
        }
    }
    void Cut(LinkTime time)
    {
        medium.Cut = true;
        Run(time);
        medium.Cut = false;
    }
    void KillProgram()
    {
        repeated += fetch->Repeated();
        underWay.clear();
        medium.B.Restart();
        Begin();
    }
    void KillNode() { medium.A.Restart(); }
    std::uint64_t Repeated() const { return repeated + fetch->Repeated(); }

    ThinMedium medium;
    std::uint64_t received = 0;

private:
    void Begin() { fetch = std::make_unique<FileFetch>("map", received, random()); }
    void AnswerTo(const Question &question)
    {
        Answer answer;
        answer.kind = question.kind;
        answer.number = question.number;
        answer.name = question.name;
        answer.from = question.from;
        answer.to = question.to;
        answer.size = FileSize;
        answer.bytes.resize(question.kind == Kind::PART ? question.to - question.from : 32);
        Send(medium.A, "beta", question.number, 60 + answer.bytes.size());
        answers[question.number] = std::move(answer);
    }
    // The message has the number alone; what it stands for is kept here.
    std::uint64_t Send(ThinMedium::Member &from, const char *to, std::uint64_t number, std::size_t size)
    {
        LinkBytes payload(size);
        std::memset(payload.Writable().data(), 0, size);
        std::memcpy(payload.Writable().data() + 8, &number, sizeof number);
        return from.Node
            ->Enqueue(to, "Backfill", "Type", std::make_shared<const LinkBytes>(std::move(payload)),
                      medium.Now)
            .Id;
    }
    static std::uint64_t NumberIn(std::span<const std::uint8_t> payload)
    {
        std::uint64_t number = 0;
        std::memcpy(&number, payload.data() + 8, sizeof number);
        return number;
    }

    std::mt19937_64 random{1};
    std::map<std::uint64_t, Question> questions;
    std::map<std::uint64_t, Answer> answers;
    std::map<std::uint64_t, std::uint64_t> underWay;  // numbers of questions, by the id of their message
    std::unique_ptr<FileFetch> fetch;
    std::uint64_t repeated = 0;
};

TEST(FileFetchThinMediumTest, ALargeFileFillsTheChannelThroughTenCutsAndAKillOfEachEnd)
{
    Transfer transfer;
    constexpr LinkTime cut = 5s;
    for (std::uint64_t part = 1; part <= 10; ++part)
    {
        ASSERT_TRUE(transfer.RunUntil(FileSize * part / 12));
        transfer.Cut(cut);
        if (part == 3)
        {
            transfer.KillProgram();
        }
        if (part == 7)
        {
            transfer.KillNode();
        }
    }
    ASSERT_TRUE(transfer.RunUntil(FileSize));
    EXPECT_EQ(transfer.received, FileSize);
    const double seconds =
        std::chrono::duration<double>(transfer.medium.Now - LinkTime(1s) - 10 * cut).count();
    const double carried = static_cast<double>(transfer.medium.BytesCarried);
    std::printf(
        "%.1f s beside the cuts; bytes of the file fill %.1f %% of the channel, all bytes %.1f %%; %.3f "
        "bytes sent for each; %.2f %% came again\n",
        seconds, 100 * static_cast<double>(FileSize) * 8 / 250e3 / seconds,
        100 * carried * 8 / 250e3 / seconds, carried / static_cast<double>(FileSize),
        100 * static_cast<double>(transfer.Repeated()) / static_cast<double>(FileSize));
    EXPECT_GE(carried * 8 / 250e3 / seconds, 0.85);
    EXPECT_LE(static_cast<double>(transfer.Repeated()), 0.02 * static_cast<double>(FileSize));
    // Headers and acknowledgements take 15 %, and what was under way at cuts and kills is sent once more.
    EXPECT_LE(carried, 1.19 * static_cast<double>(FileSize));
}

}  // namespace
}  // namespace Rabit::Backfill
