// Origins and one recording node over links that are cut and ends that are killed, under simulated time. In
// the end the recording holds each post of each origin's recording once, byte for byte, at its time.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "backfill/PostAnswers.h"
#include "backfill/Requester.h"

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;
using Time = std::chrono::milliseconds;

constexpr Time Written = 500ms;  // until a recorded post survives a kill
constexpr Time Whole = 1000ms;   // an origin tells of older posts only
constexpr std::int64_t Epoch = 1'795'725'000'000'000'000;

// The recording of one origin.
class MemoryStore final : public PostStore
{
public:
    struct Life
    {
        std::map<std::string, std::map<Stamp, Post>> Posts;  // by message
        bool IsOver = false;
    };
    std::map<std::uint64_t, Life> Lives;
    std::int64_t Now = 0;

    std::optional<std::vector<PostsCodec::Span>> Spans(const std::string &message, std::uint64_t) override
    {
        std::vector<PostsCodec::Span> spans;
        for (const auto &[incarnation, life] : Lives)
        {
            const auto posts = life.Posts.find(message);
            if (posts != life.Posts.end() && !posts->second.empty())
            {
                const Stamp end = life.IsOver ? posts->second.rbegin()->first + 1
                                              : StampOf(Now - std::chrono::nanoseconds(Whole).count());
                spans.push_back({incarnation, {posts->second.begin()->first, end}, life.IsOver});
            }
        }
        return spans;
    }
    Found Read(const std::string &message, std::uint64_t incarnation, Range range,
               const std::vector<Stamp> &had, std::size_t most) override
    {
        Found found{.First = range.First, .Posts = {}};
        const auto &posts = Lives.at(incarnation).Posts.at(message);
        std::size_t bytes = 0;
        for (auto post = posts.lower_bound(range.End); post != posts.lower_bound(range.First);)
        {
            --post;
            if (std::binary_search(had.begin(), had.end(), post->first))
            {
                continue;
            }
            bytes += post->second.Bytes.size();
            if (bytes > most && !found.Posts.empty())
            {
                break;
            }
            found.Posts.insert(found.Posts.begin(), post->second);
            found.First = post->first;
            if (bytes > most)
            {
                break;
            }
        }
        if (bytes <= most)
        {
            found.First = range.First;
        }
        return found;
    }
    std::uint64_t Present() const override { return Lives.empty() ? 0 : Lives.rbegin()->first; }
};

class Simulation
{
public:
    explicit Simulation(unsigned seed) : _random(seed), _loss(Chance() * 0.4)
    {
        for (int i = 0; i < 1 + static_cast<int>(_random() % 3); ++i)
        {
            _origins.emplace("uav" + std::to_string(i + 1), std::make_unique<Origin>());
        }
        for (auto &[name, origin] : _origins)
        {
            Begin(*origin);
        }
        BeginGround();
    }

    void Run(Time until, bool hasFaults)
    {
        for (; _now < until; _now += 10ms)
        {
            if (hasFaults)
            {
                Fault();
            }
            for (auto &[name, origin] : _origins)
            {
                origin->IsCut = hasFaults && _now < origin->CutUntil;
                Step(name, *origin, hasFaults);
            }
            Arrive();
            StepGround();
        }
    }

    // Returns what is wrong.
    std::string Check() const
    {
        std::map<Series, std::map<Stamp, int>> written;
        for (const Entry &entry : _file)
        {
            if (!entry.IsMark)
            {
                ++written[entry.Of][StampOf(entry.What.SourceTime)];
            }
        }
        for (const auto &[name, origin] : _origins)
        {
            for (const auto &[incarnation, life] : origin->Store.Lives)
            {
                for (const auto &[message, posts] : life.Posts)
                {
                    for (const auto &[stamp, post] : posts)
                    {
                        const int count = written[{name, message, incarnation}][stamp];
                        if (count != 1)
                        {
                            return name + " " + message + " " + std::to_string(incarnation) + ": post " +
                                   std::to_string(stamp) + " was written " + std::to_string(count) + " times";
                        }
                    }
                }
            }
        }
        for (const Entry &entry : _file)
        {
            if (!entry.IsMark && entry.What.Bytes != BytesOf(entry.Of, StampOf(entry.What.SourceTime)))
            {
                return "a post has other bytes";
            }
            if (entry.IsBackfilled)
            {
                const auto &life = _origins.at(entry.Of.Node)->Store.Lives.at(entry.Of.Incarnation);
                const auto &posts = life.Posts.at(entry.Of.Message);
                if (!(posts.at(StampOf(entry.What.SourceTime)) == entry.What))
                {
                    return "a post has another time";
                }
            }
        }
        return "";
    }
    std::uint64_t Backfilled() const
    {
        return static_cast<std::uint64_t>(
            std::count_if(_file.begin(), _file.end(), [](const Entry &entry) { return entry.IsBackfilled; }));
    }

private:
    struct Origin
    {
        MemoryStore Store;
        std::uint64_t Incarnation = 0;
        std::deque<std::pair<Time, std::pair<std::string, Stamp>>> Unwritten;
        Time NextPost{0};
        Time CutUntil{0};
        Time DownUntil{0};
        bool IsCut = false;
    };
    // One line of the recording.
    struct Entry
    {
        Time At{0};
        Series Of{};
        Post What{};
        Range Mark{};
        bool IsMark = false;
        bool IsBackfilled = false;
    };
    struct Sample
    {
        Time Arrives{0};
        Series Of{};
        Post What{};
    };
    struct Mail
    {
        Time Arrives{0};
        std::string Node{};  // the origin
        std::uint64_t Incarnation = 0;
        std::uint64_t Ground = 0;
        Question Asked{};
        Answer Answered{};
        bool IsAnswer = false;
    };

    double Chance() { return std::uniform_real_distribution<>(0, 1)(_random); }
    Time Soon(int most) { return Time(static_cast<int>(_random() % static_cast<unsigned>(most))); }
    std::int64_t SourceNow() const { return Epoch + std::chrono::nanoseconds(_now).count(); }
    // The content of a post follows from its name, so that each is known.
    static std::vector<std::uint8_t> BytesOf(const Series &series, Stamp stamp)
    {
        std::mt19937_64 content(stamp * 31 + series.Incarnation + series.Message.size());
        std::vector<std::uint8_t> bytes(20 + content() % (series.Message == "Picture" ? 20'000 : 100));
        for (std::uint8_t &byte : bytes)
        {
            byte = static_cast<std::uint8_t>(content());
        }
        return bytes;
    }

    void Begin(Origin &origin)
    {
        origin.Incarnation += 1 + _random() % 5;
        origin.Store.Lives[origin.Incarnation];
    }
    void BeginGround()
    {
        ++_ground;
        _ledger = std::make_unique<Ledger>();
        _requester = std::make_unique<Requester>(*_ledger, 86400s, _random());
        for (const Entry &entry : _file)
        {
            if (entry.IsMark)
            {
                _ledger->SetWhole(entry.Of, entry.Mark);
            }
            else
            {
                _ledger->Take(entry.Of, StampOf(entry.What.SourceTime));
            }
        }
    }
    void Fault()
    {
        for (auto &[name, origin] : _origins)
        {
            if (Chance() < 0.0003)
            {
                origin->CutUntil = _now + Soon(60'000);
            }
            if (Chance() < 0.0002)
            {
                Kill(*origin);
            }
        }
        if (Chance() < 0.0003)
        {
            std::erase_if(_file, [this](const Entry &entry) { return entry.At > _now - Written; });
            BeginGround();
        }
    }
    void Kill(Origin &origin)
    {
        MemoryStore::Life &life = origin.Store.Lives[origin.Incarnation];
        for (const auto &[at, post] : origin.Unwritten)
        {
            life.Posts[post.first].erase(post.second);
        }
        origin.Unwritten.clear();
        life.IsOver = true;
        origin.DownUntil = _now + Soon(10'000);
        Begin(origin);
    }
    void Step(const std::string &name, Origin &origin, bool hasFaults)
    {
        origin.Store.Now = SourceNow();
        while (!origin.Unwritten.empty() && origin.Unwritten.front().first <= _now - Written)
        {
            origin.Unwritten.pop_front();
        }
        if (_now < origin.DownUntil || _now < origin.NextPost || _now >= _noPostsAfter)
        {
            return;
        }
        origin.NextPost = _now + Soon(300);
        const std::string message = _random() % 10 == 0 ? "Picture" : "Pose";
        const std::int64_t time = SourceNow() + static_cast<std::int64_t>(_random() % 9'000'000);
        const Series series{name, message, origin.Incarnation};
        const Stamp stamp = StampOf(time);
        const Post post{time, BytesOf(series, stamp)};
        origin.Store.Lives[origin.Incarnation].Posts[message][stamp] = post;
        origin.Unwritten.emplace_back(_now, std::pair(message, stamp));
        // Some posts are skipped by design, some are lost.
        if (!origin.IsCut && _random() % 5 != 0 && !(hasFaults && Chance() < _loss))
        {
            _samples.push_back({_now + Soon(400), series, {TimeOf(stamp) + StampStep / 2, post.Bytes}});
        }
    }
    void Arrive()
    {
        for (std::size_t i = 0; i < _samples.size();)
        {
            if (_samples[i].Arrives > _now)
            {
                ++i;
                continue;
            }
            const Sample sample = std::move(_samples[i]);
            _samples.erase(_samples.begin() + static_cast<std::ptrdiff_t>(i));
            if (_ledger->Take(sample.Of, StampOf(sample.What.SourceTime)))
            {
                _file.push_back({.At = _now, .Of = sample.Of, .What = sample.What});
            }
        }
        std::deque<Mail> mails;
        mails.swap(_mails);
        for (Mail &mail : mails)
        {
            Origin &origin = *_origins.at(mail.Node);
            if (mail.Arrives > _now || origin.IsCut || _now < origin.DownUntil)
            {
                _mails.push_back(std::move(mail));
            }
            else
            {
                Arrive(mail, origin);
            }
        }
    }
    // A message of an end that is gone is in doubt: it may arrive, or not.
    void Arrive(Mail &mail, Origin &origin)
    {
        if ((mail.Incarnation != origin.Incarnation || mail.Ground != _ground) && Chance() < 0.5)
        {
            return;
        }
        if (!mail.IsAnswer)
        {
            PostAnswers answers(
                origin.Store, [](const std::string &, const std::string &) { return true; },
                [](const std::string &) { return true; });
            _mails.push_back({.Arrives = _now + Soon(1000),
                              .Node = mail.Node,
                              .Incarnation = origin.Incarnation,
                              .Ground = _ground,
                              .Answered = answers.Of("ground", mail.Asked),
                              .IsAnswer = true});
            return;
        }
        const auto whole = _requester->Answered(
            mail.Node, mail.Answered,
            [this](const Series &series, const Post &post)
            {
                if (_random() % 500 == 0)
                {
                    return Requester::Taken::NotNow;  // no room
                }
                _file.push_back({.At = _now, .Of = series, .What = post, .IsBackfilled = true});
                return Requester::Taken::Recorded;
            },
            _now);
        if (whole)
        {
            _file.push_back({.At = _now, .Of = whole->first, .Mark = whole->second, .IsMark = true});
        }
    }
    void StepGround()
    {
        for (const auto &[name, origin] : _origins)
        {
            _requester->SetNode(name, origin->Incarnation, !origin->IsCut && _now >= origin->DownUntil,
                                {"Pose", "Picture"}, _now);
        }
        for (const Requester::Asking &asking : _requester->Due(_now))
        {
            _mails.push_back({.Arrives = _now + Soon(200),
                              .Node = asking.Node,
                              .Incarnation = _origins.at(asking.Node)->Incarnation,
                              .Ground = _ground,
                              .Asked = asking.What});
        }
    }

    std::mt19937 _random;
    const double _loss;
    Time _now{0};
    const Time _noPostsAfter = 300s;
    std::map<std::string, std::unique_ptr<Origin>> _origins;
    std::uint64_t _ground = 0;
    std::unique_ptr<Ledger> _ledger;
    std::unique_ptr<Requester> _requester;
    std::vector<Entry> _file;
    std::vector<Sample> _samples;
    std::deque<Mail> _mails;
};

TEST(BackfillSimulationTest, EachPostIsRecordedOnceByteForByteAtItsTime)
{
    std::uint64_t backfilled = 0;
    for (unsigned seed = 1; seed <= 20; ++seed)
    {
        Simulation simulation(seed);
        simulation.Run(300s, true);
        // Large posts come one by one, with rests in between.
        for (Time until = 400s; until <= 6000s && !simulation.Check().empty(); until += 100s)
        {
            simulation.Run(until, false);
        }
        ASSERT_EQ(simulation.Check(), "") << "seed " << seed;
        backfilled += simulation.Backfilled();
    }
    EXPECT_GT(backfilled, 1000U);
}

}  // namespace
}  // namespace Rabit::Backfill
