// The entry point that idlc calls when it is run as `idlc -l <this library> file.idl`.
#include "HeaderEmitter.h"
#include "SourceEmitter.h"
#include "model/IdlTree.h"
#include "model/ModelReader.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

namespace
{

// Writes the whole file or nothing: an interrupted run must not leave half a header behind.
void WriteFile(const std::filesystem::path &path, const std::string &text)
{
    std::filesystem::path partial = path;
    partial += ".part";
    {
        std::ofstream file(partial, std::ios::binary | std::ios::trunc);
        file << text;
        file.close();
        if (!file)
        {
            throw std::runtime_error("cannot write " + partial.string());
        }
    }
    std::filesystem::rename(partial, path);
}

// The dependency file for make and ninja: the files that the output depends on.
std::string DependencyFile(const std::filesystem::path &target, const std::vector<std::string> &sources)
{
    const auto escaped = [](const std::string &path)
    {
        std::string text;
        for (const char letter : path)
        {
            text += letter == ' ' || letter == '#' ? std::string("\\") + letter : std::string(1, letter);
        }
        return text;
    };
    std::string text = escaped(target.string()) + ":";
    for (const std::string &source : sources)
    {
        text += " " + escaped(source);
    }
    return text + "\n";
}

void Generate(const RabitIdl::Model &model, const std::filesystem::path &directory)
{
    const std::filesystem::path header = directory / (model.MainFile + ".h");
    std::filesystem::create_directories(header.parent_path());
    WriteFile(directory / (model.MainFile + ".d"), DependencyFile(header, model.AllPaths));
    WriteFile(directory / (model.MainFile + ".cpp"), RabitIdl::EmitSource(model));
    WriteFile(header, RabitIdl::EmitHeader(model));
}

}  // namespace

// Returns 0 if both files were written. Declared by idlc/generator.h, which is C only.
extern "C" __attribute__((visibility("default"))) int generate(const void *state, const void *config)
{
    try
    {
        RabitIdl::Refusals refusals;
        const char *base = TreeBaseDirectory(config);
        RabitIdl::ModelReader reader(state, refusals, base != nullptr ? base : "");
        const RabitIdl::Model model = reader.Read();
        if (!refusals.Empty())
        {
            refusals.Print();
            return -1;
        }
        const char *directory = TreeOutputDirectory(config);
        Generate(model,
                 std::filesystem::absolute(directory != nullptr && *directory != '\0' ? directory : "."));
        return 0;
    }
    catch (const std::exception &error)
    {
        std::fprintf(stderr, "Rabit IDL generator: %s\n", error.what());
        return -1;
    }
}
