#include "recording/merge/AgePlot.h"

#include <rabit/base/Printable.h>

#include <boost/algorithm/string/replace.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <set>

namespace Rabit::Merge
{
namespace
{

constexpr double Left = 90;
constexpr double Width = static_cast<double>(AgePlot::Columns);
constexpr double Legend = 170;
constexpr double Head = 64;
constexpr double PanelHead = 26;
constexpr double PanelHeight = 130;
constexpr double PanelFoot = 26;
constexpr double Foot = 24;

constexpr double LegendLine = 15;

// Colours that colour-blind people can tell apart, too (Okabe and Ito).
constexpr std::array<const char *, 7> Colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#56b4e9", "#e69f00", "#444444"};

std::string Number(double value)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f", value);
    return text.data();
}

// Escapes XML, and replaces all but printable ASCII by `?`: texts of a file may hold anything.
std::string Escaped(std::string text)
{
    text = Printable(std::move(text));
    boost::algorithm::replace_all(text, "&", "&amp;");
    boost::algorithm::replace_all(text, "<", "&lt;");
    boost::algorithm::replace_all(text, ">", "&gt;");
    return text;
}

// Returns a colour that no other number has. After the first ones the hues follow by the golden angle, which
// keeps them apart, each a little darker than the one before.
std::string ColourOf(std::size_t number)
{
    if (number < Colours.size())
    {
        return Colours[number];
    }
    constexpr double goldenAngle = 137.508;
    const double hue = std::fmod(goldenAngle * static_cast<double>(number), 360.0) / 60.0;
    const double light = 200.0 - 40.0 * static_cast<double>(number % 3);
    const auto part = [&](double at)
    {
        const double distance = std::abs(std::remainder(hue - at, 6.0));
        return static_cast<unsigned>(light * std::clamp(2.0 - distance, 0.0, 1.0));
    };
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", part(0.0) & 0xffU, part(2.0) & 0xffU,
                  part(4.0) & 0xffU);
    return text.data();
}

std::string AgeText(int decade)
{
    static constexpr std::array<const char *, 9> texts = {"0.01 ms", "0.1 ms", "1 ms",  "10 ms", "0.1 s",
                                                          "1 s",     "10 s",   "100 s", "1000 s"};
    return decade >= -5 && decade <= 3 ? texts[static_cast<std::size_t>(decade + 5)]
                                       : "1e" + std::to_string(decade) + " s";
}

// Returns a step that gives no more than twelve marks.
double StepFor(double seconds)
{
    for (double step :
         {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0})
    {
        if (seconds / step <= 12)
        {
            return step;
        }
    }
    return 3600.0 * std::ceil(seconds / 3600.0 / 12);
}

class Drawing
{
public:
    explicit Drawing(const AgePlot &plot) : _plot(plot)
    {
        FindDecades();
        GiveColours();
    }

    std::string Run()
    {
        double height = Head + Foot;
        for (const AgePlot::Panel &panel : _plot.Panels)
        {
            height += PanelHead + HeightOf(panel) + PanelFoot;
        }
        const std::string size = Number(Left + Width + Legend) + " " + Number(height);
        _svg = R"(<svg xmlns="http://www.w3.org/2000/svg" version="1.1" width=")" +
               Number(Left + Width + Legend) + R"(" height=")" + Number(height) + R"(" viewBox="0 0 )" +
               size + "\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"12\" fill=\"#222\">\n" +
               "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
        Text(Left, 26, _plot.Title, "font-size=\"16\" font-weight=\"bold\"");
        Text(Left, 46, _plot.Note, "fill=\"#666\"");
        double top = Head;
        for (const AgePlot::Panel &panel : _plot.Panels)
        {
            Draw(panel, top + PanelHead);
            top += PanelHead + HeightOf(panel) + PanelFoot;
        }
        Text(Left + Width / 2, top + 12, "time since the beginning (s)", "text-anchor=\"middle\"");
        return std::move(_svg) + "</svg>\n";
    }

private:
    static std::set<std::string> MessagesOf(const AgePlot::Panel &panel)
    {
        std::set<std::string> messages;
        for (const AgePlot::Line &line : panel.Lines)
        {
            messages.insert(line.Message);
        }
        return messages;
    }

    // The legend has a line for each message.
    static double HeightOf(const AgePlot::Panel &panel)
    {
        return std::max(PanelHeight, LegendLine * static_cast<double>(MessagesOf(panel).size()));
    }

    void FindDecades()
    {
        Moment youngest = FarthestMoment;
        Moment oldest = 0;
        for (const AgePlot::Panel &panel : _plot.Panels)
        {
            for (const AgePlot::Line &line : panel.Lines)
            {
                for (const AgeHistory::Column &column : line.Ages->Columns())
                {
                    youngest = column.IsKnown ? std::min(youngest, column.Youngest) : youngest;
                    oldest = column.IsKnown ? std::max(oldest, column.Oldest) : oldest;
                }
            }
        }
        // The axis begins at 0.1 ms or above: smaller ages are noise.
        _least =
            static_cast<int>(std::floor(std::log10(std::max(1e-9 * static_cast<double>(youngest), 1e-4))));
        _most = static_cast<int>(std::ceil(std::log10(std::max(1e-9 * static_cast<double>(oldest), 1e-3))));
        _least = std::min(_least, 2);
        _most = std::max(_most, _least + 1);
    }

    void GiveColours()
    {
        std::set<std::string> messages;
        for (const AgePlot::Panel &panel : _plot.Panels)
        {
            messages.merge(MessagesOf(panel));
        }
        for (const std::string &message : messages)
        {
            _colours.emplace(message, ColourOf(_colours.size()));
        }
    }

    void Draw(const AgePlot::Panel &panel, double top)
    {
        _height = HeightOf(panel);
        const double bottom = top + _height;
        Text(Left, top - 8, panel.Title, "font-weight=\"bold\"");
        for (int decade = _least; decade <= _most; ++decade)
        {
            const double y = Y(top, std::pow(10.0, decade));
            Rule(Left, y, Left + Width, y, "#ddd");
            Text(Left - 8, y + 4, AgeText(decade), "text-anchor=\"end\" font-size=\"11\" fill=\"#666\"");
        }
        const double seconds = 1e-9 * static_cast<double>(_plot.End - _plot.Begin);
        const double step = StepFor(seconds);
        for (int mark = 0; mark * step <= seconds * 1.0001 && mark < 100; ++mark)
        {
            const double x = Left + Width * mark * step / std::max(seconds, 1e-9);
            Rule(x, top, x, bottom, "#eee");
            Text(x, bottom + 15, step < 1 ? Number(mark * step) : std::to_string(std::lround(mark * step)),
                 "text-anchor=\"middle\" font-size=\"11\" fill=\"#666\"");
        }
        _svg += "<rect x=\"" + Number(Left) + "\" y=\"" + Number(top) + "\" width=\"" + Number(Width) +
                "\" height=\"" + Number(_height) + "\" fill=\"none\" stroke=\"#999\"/>\n";
        const std::string middle = Number(top + _height / 2);
        Text(22, top + _height / 2, "age",
             "text-anchor=\"middle\" transform=\"rotate(-90 22 " + middle + ")\"");
        double legend = top + 12;
        std::set<std::string> named;
        // Lines come over all ranges, and those of every second message are dashed: so none hides another
        // one.
        for (const bool isRange : {true, false})
        {
            for (const AgePlot::Line &line : panel.Lines)
            {
                const auto colour = _colours.find(line.Message);
                const bool isDashed = std::distance(_colours.begin(), colour) % 2 == 1;
                Draw(*line.Ages, top, colour->second, isRange, isDashed);
            }
        }
        for (const AgePlot::Line &line : panel.Lines)
        {
            const std::string colour = _colours.at(line.Message);
            if (!named.insert(line.Message).second)
            {
                continue;
            }
            Rule(Left + Width + 12, legend - 4, Left + Width + 32, legend - 4, colour.c_str(), 3);
            Text(Left + Width + 38, legend, line.Message, "font-size=\"11\"");
            legend += LegendLine;
        }
    }

    // Draws each stretch without a gap.
    void Draw(const AgeHistory &ages, double top, const std::string &colour, bool isRange, bool isDashed)
    {
        const auto &columns = ages.Columns();
        for (std::size_t begin = 0; begin < columns.size();)
        {
            std::size_t end = begin;
            while (end < columns.size() && columns[end].IsKnown)
            {
                ++end;
            }
            if (end > begin)
            {
                Draw(columns, begin, end, top, colour, isRange, isDashed);
            }
            begin = end + 1;
        }
    }

    void Draw(const std::vector<AgeHistory::Column> &columns, std::size_t begin, std::size_t end, double top,
              const std::string &colour, bool isRange, bool isDashed)
    {
        const double width = Width / static_cast<double>(columns.size());
        const auto point = [&](std::size_t column, Moment age)
        {
            return Number(Left + width * (static_cast<double>(column) + 0.5)) + "," +
                   Number(Y(top, 1e-9 * static_cast<double>(age))) + " ";
        };
        std::string oldest;
        std::string youngest;
        for (std::size_t column = begin; column < end; ++column)
        {
            oldest += point(column, columns[column].Oldest);
            youngest += point(end - 1 - (column - begin), columns[end - 1 - (column - begin)].Youngest);
        }
        if (isRange)
        {
            _svg += "<polygon points=\"" + oldest + youngest + "\" fill=\"" + colour +
                    "\" fill-opacity=\"0.25\"/>\n";
            return;
        }
        _svg += "<polyline points=\"" + oldest + "\" fill=\"none\" stroke=\"" + colour +
                "\" stroke-width=\"1.2\"" + (isDashed ? " stroke-dasharray=\"6 4\"" : "") + "/>\n";
    }

    double Y(double top, double seconds) const
    {
        const double decades = std::log10(std::max(seconds, std::pow(10.0, _least))) - _least;
        return top + _height * (1.0 - std::min(1.0, decades / (_most - _least)));
    }

    void Text(double x, double y, const std::string &text, const std::string &style)
    {
        _svg += "<text x=\"" + Number(x) + "\" y=\"" + Number(y) + "\" " + style + ">" + Escaped(text) +
                "</text>\n";
    }

    void Rule(double fromX, double fromY, double toX, double toY, const char *colour, int width = 1)
    {
        _svg += "<line x1=\"" + Number(fromX) + "\" y1=\"" + Number(fromY) + "\" x2=\"" + Number(toX) +
                "\" y2=\"" + Number(toY) + "\" stroke=\"" + colour + "\" stroke-width=\"" +
                std::to_string(width) + "\"/>\n";
    }

    const AgePlot &_plot;
    std::string _svg;
    double _height = PanelHeight;  // of the panel that is drawn
    int _least = 0;                // decades of seconds
    int _most = 0;
    std::map<std::string, std::string> _colours;
};

}  // namespace

std::string AgePlot::ToSvg() const
{
    return Drawing(*this).Run();
}

}  // namespace Rabit::Merge
