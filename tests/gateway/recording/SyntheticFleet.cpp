#include "SyntheticFleet.h"

#include <cstring>
#include <sstream>
#include <utility>

using namespace Rabit;

namespace
{

constexpr SyntheticFleet::Time Second = 1000000000;
// A peer that was not heard for this long is not echoed any more.
constexpr SyntheticFleet::Time Lost = 4 * Second;
// A node's monotonic clock and its source clock begin anywhere.
constexpr SyntheticFleet::Time Epoch = 1700000000 * Second;

SyntheticFleet::Time MonotonicStart(std::size_t node)
{
    return static_cast<SyntheticFleet::Time>(node + 1) * 1000 * Second;
}

SyntheticFleet::Time SourceAhead(std::size_t node)
{
    return static_cast<SyntheticFleet::Time>(node + 5) * 100000 * Second;
}

}  // namespace

SyntheticFleet::SyntheticFleet(std::vector<Spec> specs, Network network, unsigned seed)
    : _network(std::move(network)), _random(seed)
{
    for (Spec &spec : specs)
    {
        _nodes.push_back({});
        _nodes.back().Is = std::move(spec);
    }
    for (std::size_t node = 0; node < _nodes.size(); ++node)
    {
        const Time phase = static_cast<Time>(_random() % 400) * 1000000;
        const Time begin = _nodes[node].Is.Begin + phase;
        Repeat(node, begin, Second / 2, [this, node](Time at) { Beat(node, at); });
        Repeat(node, begin + 1, Second / 5, [this, node](Time at) { Post(node, at); });
        Repeat(node, begin + Second / 3, Second, [this, node](Time at) { Report(node, at); });
    }
    while (!_events.empty())
    {
        const Event event = _events.top();
        _events.pop();
        event.Do();
    }
    for (Node &node : _nodes)
    {
        if (node.Writer)
        {
            node.Writer->Finish();
        }
    }
}

SyntheticFleet::Time SyntheticFleet::MonotonicAt(std::size_t node, Time at) const
{
    const Spec &spec = _nodes[node].Is;
    Time ran = at;
    if (spec.Stands && at > spec.Stands->At)
    {
        ran -= std::min(spec.Stands->For, at - spec.Stands->At);
    }
    return MonotonicStart(node) + ran + static_cast<Time>(static_cast<double>(ran) * spec.Rate);
}

SyntheticFleet::Time SyntheticFleet::ToLog(std::size_t node, Time monotonic) const
{
    return monotonic - MonotonicStart(node) + Epoch + _nodes[node].Is.WallAhead;
}

SyntheticFleet::Time SyntheticFleet::LogAt(std::size_t node, Time at) const
{
    return ToLog(node, MonotonicAt(node, at));
}

SyntheticFleet::Time SyntheticFleet::Awake(std::size_t node, Time at) const
{
    const auto &stands = _nodes[node].Is.Stands;
    return stands && at >= stands->At && at < stands->At + stands->For ? stands->At + stands->For : at;
}

bool SyntheticFleet::Lives(std::size_t node, Time at) const
{
    return at >= _nodes[node].Is.Begin && at < _nodes[node].Is.End;
}

void SyntheticFleet::Schedule(Time at, std::function<void()> action)
{
    _events.push({at, _order++, std::move(action)});
}

void SyntheticFleet::Repeat(std::size_t node, Time at, Time period, const std::function<void(Time)> &action)
{
    Schedule(at,
             [this, node, at, period, action]
             {
                 if (!Lives(node, at))
                 {
                     return;
                 }
                 action(at);
                 Repeat(node, Awake(node, at + period), period, action);
             });
}

void SyntheticFleet::Beat(std::size_t from, Time at)
{
    const Time now = MonotonicAt(from, at);
    for (std::size_t to = 0; to < _nodes.size(); ++to)
    {
        const auto delay = to == from ? std::nullopt : _network(from, to, at, _random);
        if (!delay)
        {
            continue;
        }
        // The last beat of the other node, and the time since it arrived here.
        std::optional<std::pair<Time, Time>> echo;
        if (const Heard &heard = _nodes[from].Peers[to]; heard.HasBeat && now - heard.Arrival < Lost)
        {
            echo = {heard.BeatSource, now - heard.Arrival};
        }
        const Time arrival = Awake(to, at + *delay);
        Schedule(arrival, [this, to, from, now, echo, arrival]
                 { TakeBeat(to, from, now + SourceAhead(from), echo, arrival); });
    }
}

void SyntheticFleet::TakeBeat(std::size_t to, std::size_t from, Time source,
                              std::optional<std::pair<Time, Time>> echo, Time at)
{
    if (!Lives(to, at))
    {
        return;
    }
    Heard &heard = _nodes[to].Peers[from];
    const Time now = MonotonicAt(to, at);
    heard.Clock.OnBeat({std::chrono::nanoseconds(source), std::chrono::nanoseconds(source)},
                       std::chrono::nanoseconds(now));
    heard.HasBeat = true;
    heard.BeatSource = source;
    heard.Arrival = now;
    if (echo)
    {
        const Time roundTrip = now - (echo->first - SourceAhead(to)) - echo->second;
        heard.Clock.OnRoundTrip(std::chrono::nanoseconds(roundTrip), std::chrono::nanoseconds(now));
    }
}

void SyntheticFleet::Post(std::size_t from, Time at)
{
    const Time source = MonotonicAt(from, at) + SourceAhead(from);
    const std::string topic = _nodes[from].Is.Name + "/Pose";
    Record(from, at, topic, "posted", _nodes[from].Is.Name, LogAt(from, at), PoseOf(at));
    for (std::size_t to = 0; to < _nodes.size(); ++to)
    {
        const auto delay = to == from ? std::nullopt : _network(from, to, at, _random);
        if (!delay)
        {
            continue;
        }
        const Time arrival = Awake(to, at + *delay);
        Schedule(arrival,
                 [this, to, from, source, at, arrival, topic]
                 {
                     Heard &heard = _nodes[to].Peers[from];
                     const auto posted = heard.Clock.ToLocal(std::chrono::nanoseconds(source));
                     if (Lives(to, arrival) && posted && at > heard.LastPose)
                     {
                         heard.LastPose = at;
                         Record(to, arrival, topic, "mirrored", _nodes[from].Is.Name,
                                ToLog(to, posted->count()), PoseOf(at));
                     }
                 });
    }
}

void SyntheticFleet::Report(std::size_t node, Time at)
{
    const auto about = [this, node](std::uint64_t incarnation, Time sourceToMonotonic)
    {
        std::ostringstream text;
        text << R"("incarnation":")" << incarnation << R"(","source_to_log_ns":")"
             << ToLog(node, sourceToMonotonic) << '"';
        return text.str();
    };
    std::ostringstream report;
    report << '{' << about(_nodes[node].Is.Incarnation, -SourceAhead(node)) << R"(,"peers":[)";
    const char *comma = "";
    for (const auto &[peer, heard] : _nodes[node].Peers)
    {
        if (const auto relation = heard.Clock.Source())
        {
            const auto roundTrip = heard.Clock.RoundTrip();
            report << std::exchange(comma, ",") << R"({"node":")" << _nodes[peer].Is.Name << R"(",)"
                   << about(_nodes[peer].Is.Incarnation, relation->ToLocal.count())
                   << R"(,"uncertain_by_ns":)"
                   << (roundTrip ? std::to_string(roundTrip->count() / 2) : "null") << '}';
        }
    }
    report << "]}";
    const std::string text = report.str();
    Record(node, at, _nodes[node].Is.Name + "/Recorder/Clocks", "recorder", _nodes[node].Is.Name,
           LogAt(node, at), {text.begin(), text.end()});
    if (_nodes[node].Writer)
    {
        _nodes[node].Writer->FinishChunks();
    }
}

void SyntheticFleet::Record(std::size_t node, Time at, const std::string &topic, const std::string &kind,
                            const std::string &origin, Time publishLog, const Mcap::Bytes &data)
{
    Node &recorder = _nodes[node];
    if (!recorder.Is.IsRecorded)
    {
        return;
    }
    const auto logTime = static_cast<std::uint64_t>(LogAt(node, at));
    const auto write = [&recorder, logTime](const std::string &to, const std::string &as,
                                            const std::string &of, Time posted, const Mcap::Bytes &bytes)
    {
        const auto [channel, isNew] = recorder.Channels.try_emplace(to);
        if (isNew)
        {
            const bool isJson = as == "recorder";
            const std::uint16_t schema =
                isJson ? recorder.Writer->AddSchema("rabit.Clocks", "jsonschema", "{}")
                       : recorder.Writer->AddSchema(
                             "Test::Pose", "omgidl",
                             // As Rabit wrote it before, and as it does.
                             std::string("module Test {\n@final\nstruct Pose {\n    long long ") +
                                 (recorder.Is.Incarnation % 2 == 0 ? "_Port" : "Port") + ";\n};\n};\n");
            channel->second = *recorder.Writer->AddChannel(schema, to, isJson ? "json" : "cdr",
                                                           {{"rabit.kind", as}, {"rabit.node", of}});
        }
        recorder.Writer->Add({channel->second, 0, logTime, static_cast<std::uint64_t>(posted), bytes});
    };
    const bool isDue = recorder.Is.SplitEvery != 0 && at >= recorder.FileBegan + recorder.Is.SplitEvery;
    if (!recorder.Writer || isDue)
    {
        Split(node, at);
        for (const auto &[name, last] : recorder.LastOfStates)
        {
            const std::string from = name.substr(0, name.find('/'));
            write(name, from == recorder.Is.Name ? "posted" : "mirrored", from, last.first, last.second);
        }
    }
    write(topic, kind, origin, publishLog, data);
    if (kind != "recorder")
    {
        recorder.LastOfStates[topic] = {publishLog, data};
    }
}

void SyntheticFleet::Split(std::size_t node, Time at)
{
    Node &recorder = _nodes[node];
    if (recorder.Writer)
    {
        recorder.Writer->Finish();
    }
    recorder.Channels.clear();
    recorder.FileBegan = at;
    const std::string life = recorder.Is.Name + "_" + std::to_string(recorder.Is.Incarnation);
    const std::string number = std::to_string(++recorder.FileNumber);
    recorder.File = std::make_shared<MemoryFile>();
    Files[life + "_" + number + ".mcap"] = recorder.File;
    recorder.Writer =
        std::make_unique<Mcap::McapWriter>(*recorder.File, Mcap::McapWriter::Options{"test", "rabit", true});
    recorder.Writer->AddMetadata(
        {"rabit.file", {{"node", recorder.Is.Name}, {"number", number}, {"recording", life}}});
    recorder.Writer->AddMetadata({"rabit.node", {{"node", recorder.Is.Name}, {"host", recorder.Is.Name}}});
}

Merge::OpenFile SyntheticFleet::Opener() const
{
    class Borrowed final : public Mcap::ByteSource
    {
    public:
        explicit Borrowed(std::shared_ptr<MemoryFile> file) : _file(std::move(file)) {}
        std::uint64_t Size() override { return _file->Size(); }
        bool Read(std::uint64_t offset, std::span<std::uint8_t> to) override
        {
            return _file->Read(offset, to);
        }

    private:
        const std::shared_ptr<MemoryFile> _file;
    };
    return [files = Files](const std::string &path) { return std::make_unique<Borrowed>(files.at(path)); };
}

std::vector<std::string> SyntheticFleet::Paths() const
{
    std::vector<std::string> paths;
    for (const auto &[path, file] : Files)
    {
        paths.push_back(path);
    }
    return paths;
}

Mcap::Bytes SyntheticFleet::PoseOf(Time posted)
{
    Mcap::Bytes bytes = {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    std::memcpy(bytes.data() + 4, &posted, sizeof posted);
    return bytes;
}

SyntheticFleet::Time SyntheticFleet::PostedOf(Mcap::ByteView data)
{
    Time posted = 0;
    std::memcpy(&posted, data.data() + 4, sizeof posted);
    return posted;
}
