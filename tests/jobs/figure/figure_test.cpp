#include "jobs/figure/figure.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/storage/atomic_file.h"
#include "jobs/figure/figure_table.h"
#include "jobs/figure/log_axis.h"
#include "jobs/figure/page.h"
#include "jobs/figure/row_pictures.h"
#include "jobs/figure/suggest.h"
#include "jobs/figure/surface.h"
#include "jobs/spec/described_json.h"
#include "renderer/core/rng.h"
#include "renderer/images/exr_write.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

constexpr int columns = 64, lines = 48;

/// A ramp, with noise of deviation `noise` at its right half and a tenth of that at its left.
std::vector<double> ramp(double noise, std::uint32_t seed) {
  Rng rng(seed, 0, 0, Rng::Purpose::test);
  std::vector<double> rgb;
  for (int i = 0; i < columns * lines; ++i) {
    const double x = double(i % columns) / columns;
    for (int c = 0; c < 3; ++c) {
      const double here = (x < 0.5 ? 0.1 : 1) * noise * (2 * double(rng.next()) - 1);
      rgb.push_back(std::max(0.0, 0.1 + 0.5 * x + here));
    }
  }
  return rgb;
}

void write_picture(const std::filesystem::path& file, std::vector<double> rgb) {
  ExrPicture picture{columns, lines, {}, PixelType::single_float, {}};
  picture.layers.push_back({"", {"R", "G", "B"}, std::move(rgb)});
  write_exr(file, picture);
}

/// A sweep of two scenes and two methods with two seeds: method `bdpt` has a quarter of the error.
class Figures : public testing::Test {
 protected:
  static constexpr const char* sweep_json = R"({"seeds": 2, "label": "tested", "job":
    {"resolution": [64, 48], "integrator": {"type": "path"},
     "budget": {"iterations": 80}}, "zip": [{"/scene": ["door.glb", "hall_2.glb"], "/reference": ["r.exr", "q.exr"]}],
    "axes": {"/integrator/type": ["path", "bdpt"]}, "baseline": {"/integrator/type": "path"},
    "exclude": [{"/integrator/type": "bdpt", "/scene": "hall_2.glb"}]})";

  void SetUp() override {
    const auto reference = temp.path() / "r.exr";
    write_picture(reference, ramp(0, 0));
    const SweepFolder sweep = SweepFolder::create(temp.path() / "a.sweep", parse_sweep(sweep_json));
    for (const SweepRun& run : sweep.plan().runs) finish(sweep, run, reference);
  }

  static void finish(const SweepFolder& sweep, const SweepRun& run,
                     const std::filesystem::path& reference) {
    const JobSpec job = sweep.plan().job_of(run);
    const JobFolder folder = JobFolder::create(sweep.folder(run).dir(), job);
    const bool better = std::holds_alternative<BdptSettings>(job.integrator);
    std::string curve =
        "iteration,seconds,cpu_seconds,mae,rmse,mse,relmse,smape,flip,est_rmse,at_floor\n";
    for (const int t : {1, 2, 4, 8}) {
      const double e = (better ? 0.02 : 0.08) * (1 + 0.1 * run.replicate) / t;
      curve += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", 10 * t, t, 0.5 * t, e, e, e, e, e,
                           std::sqrt(e), e, better && t == 8 ? 1 : 0);
    }
    write_file_atomically(folder.file("curve.csv"), curve, false);
    write_file_atomically(
        folder.file("report.json"),
        fmt::format(
            R"({{"seconds": {{"load": 0.5}}, "errors": {{"reference": {{"file": "{}"}}}}}})",
            reference.string()),
        false);
    write_picture(folder.file("image.exr"),
                  ramp(better ? 0.05 : 0.2, static_cast<std::uint32_t>(job.seed)));
    JobState state = folder.read_state();
    state.state = State::done;
    folder.write_state(state);
  }

  static constexpr const char* spec_json = R"({"sweep": "a.sweep", "metrics": ["relmse", "flip"],
    "error_map": "flip", "scenes": [
      {"name": "Door", "settings": {"/scene": "door.glb"}, "crops": [[0, 0, 16, 12], [40, 30, 16, 12]],
       "exposure": 1.5}],
    "methods": [{"name": "Path tracing", "settings": {"/integrator/type": "path"}},
                {"name": "BDPT", "settings": {"/integrator/type": "bdpt"}}]})";

  FigureSource source(const std::string& spec = spec_json) const {
    return {parse_figure(spec), temp.path()};
  }

  template <class Mark>
  static std::vector<Mark> marks(const Drawing& drawing) {
    std::vector<Mark> found;
    for (const auto& m : drawing.marks) {
      if (const auto* mark = std::get_if<Mark>(&m)) found.push_back(*mark);
    }
    return found;
  }
  static const TextMark* text(const std::vector<TextMark>& texts, const std::string& wanted) {
    for (const TextMark& t : texts) {
      if (t.text == wanted) return &t;
    }
    ADD_FAILURE() << "no text \"" << wanted << '"';
    return nullptr;
  }
  void expect_problem(const std::string& from, const std::string& to, const std::string& pointer,
                      const std::string& message) const {
    std::string spec = spec_json;
    spec.replace(spec.find(from), from.size(), to);
    try {
      source(spec);
      ADD_FAILURE() << "no problem: " << to;
    } catch (const BadJob& bad) {
      ASSERT_EQ(bad.problems().size(), 1u) << bad.what();
      EXPECT_EQ(bad.problems()[0].pointer, pointer);
      EXPECT_NE(bad.problems()[0].message.find(message), std::string::npos) << bad.what();
    }
  }
  TemporaryFolder temp;
};

TEST_F(Figures, ShowTheNumbersOfTheReport) {
  const FigureSource figure = source();
  const SweepFolder sweep(temp.path() / "a.sweep");
  const Answers report = answer(sweep);
  for (std::size_t m = 0; m < 2; ++m) {
    const CellAnswer& cell = report.cells[*figure.rows()[0].cells[m]];
    EXPECT_EQ(figure.error(0, m, 0)->error->value, cell.at.back().error->value);
    EXPECT_EQ(figure.error(0, m, 0)->error->interval->low, cell.at.back().error->interval->low);
    EXPECT_EQ(figure.time(0, m)->time->value, cell.to.back().time->value);
  }
  EXPECT_EQ(figure.best_error(0, 0), 1u);
  EXPECT_EQ(figure.best_time(0), 1u);
  const std::string value = figure_number(figure.error(0, 1, 0)->error->value);
  const std::string markdown = table_markdown(figure_table(figure));
  EXPECT_NE(markdown.find(fmt::format("**({})** [", value)), std::string::npos) << markdown;
  const std::string csv = table_csv(figure);
  EXPECT_NE(csv.find(fmt::format("Door,BDPT,relmse,8.0999999999999996,{:.17g},",
                                 figure.error(0, 1, 0)->error->value)),
            std::string::npos)
      << csv;
  EXPECT_NE(csv.find("Door,Path tracing,seconds_to_error,"), std::string::npos);
}

TEST_F(Figures, OfJobFoldersShowTheSameAsOfTheirSweep) {
  const FigureSource of_sweep = source();
  const auto jobs = [](int cell) {
    return fmt::format(R"("jobs": ["a.sweep/runs/{0:04}-1", "a.sweep/runs/{0:04}-2"])", cell);
  };
  std::string spec = spec_json;
  const auto replace = [&spec](const std::string& from, const std::string& to) {
    spec.replace(spec.find(from), from.size(), to);
  };
  replace(R"("sweep": "a.sweep", )", "");
  replace(R"("settings": {"/integrator/type": "path"})", jobs(1));
  replace(R"("settings": {"/integrator/type": "bdpt"})", jobs(3));
  const FigureSource of_jobs = source(spec);
  ASSERT_EQ(of_jobs.rows().size(), 1u);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_EQ(of_jobs.cell(0, m)->done.size(), 2u) << "seeds are runs of one cell";
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_TRUE(of_jobs.error(0, m, k)->error.has_value());
      EXPECT_EQ(of_jobs.error(0, m, k)->error->value, of_sweep.error(0, m, k)->error->value);
    }
    EXPECT_EQ(*of_jobs.picture(0, m), *of_sweep.picture(0, m));
  }
  EXPECT_EQ(of_jobs.reference(0)->rgb, of_sweep.reference(0)->rgb);
  const Drawing a = draw_figure(of_jobs), b = draw_figure(of_sweep);
  EXPECT_EQ(marks<ImageMark>(a).size(), marks<ImageMark>(b).size());
  EXPECT_EQ(a.height, b.height - 9.5) << "without the baseline's row";

  // Jobs of two pictures under one scene are two rows.
  replace(R"("settings": {"/scene": "door.glb"}, "crops": [[0, 0, 16, 12], [40, 30, 16, 12]])",
          R"("settings": {"/resolution": [64.0, 48]})");
  replace("0003-1", "0002-1");
  replace("0003-2", "0002-2");
  const FigureSource two = source(spec);
  ASSERT_EQ(two.rows().size(), 2u);
  EXPECT_TRUE(two.spec().scenes[1].name.starts_with("Door, ")) << two.spec().scenes[1].name;
  EXPECT_EQ(two.cell(0, 1), nullptr);
  EXPECT_EQ(two.cell(1, 0), nullptr);
  EXPECT_NE(two.cell(1, 1), nullptr);
}

TEST_F(Figures, AreDrawnAsTheirFileSays) {
  const Drawing d = draw_figure(source());
  EXPECT_NEAR(d.width, 178 / 25.4 * 72, 1e-9);
  const auto texts = marks<TextMark>(d);
  const auto images = marks<ImageMark>(d);
  // The whole picture, two crops of three columns, two error maps, and their colours.
  EXPECT_EQ(images.size(), 1u + 6 + 2 + 1);
  for (const char* wanted : {"Door", "Reference", "BDPT", "+1.50 stops, sRGB", "FLIP", "slope −1",
                             "render time (s)", "mostly noise of the reference"}) {
    text(texts, wanted);
  }
  const FigureSource figure = source();
  const auto label = [&](std::size_t m) {
    const ErrorAtTime& at = *figure.error(0, m, 0);
    const std::string value = figure_number(at.error->value);
    return fmt::format("relMSE {}", at.at_floor ? fmt::format("({})", value) : value);
  };
  ASSERT_NE(text(texts, label(0)), nullptr);
  EXPECT_FALSE(text(texts, label(0))->style.bold);
  EXPECT_TRUE(text(texts, label(1))->style.bold);
  for (const TextMark& t : texts) {
    EXPECT_GE(t.style.size, 4.5) << t.text;
    const double width = text_width(d.font, t.style, t.text);
    if (t.upwards) continue;
    EXPECT_GE(t.x - t.anchor * width, -0.5) << t.text;
    EXPECT_LE(t.x + (1 - t.anchor) * width, d.width + 0.5) << t.text;
    EXPECT_LE(t.y, d.height) << t.text;
  }
  for (const ImageMark& i : images) {
    EXPECT_LE(i.x + i.width, d.width + 1e-6);
    EXPECT_EQ(i.image.rgb.size(), std::size_t(3 * i.image.width * i.image.height));
  }
  // A band and a line for each method.
  EXPECT_EQ(marks<AreaMark>(d).size(), 2u);
}

TEST_F(Figures, HaveCropsOfOneExposure) {
  const RowPictures row = read_row(source(), 0, 1000);
  ASSERT_EQ(row.details.size(), 3u);
  const std::vector<double> reference = ramp(0, 0);
  const double shown = reference[3 * (30 * columns + 40)] * std::exp2(1.5);
  const double srgb = 1.055 * std::pow(std::min(shown, 1.0), 1 / 2.4) - 0.055;
  EXPECT_NEAR(row.details[2][1].rgb[0], 255 * srgb, 1);
  EXPECT_EQ(row.details[2][1].width, 16);
  EXPECT_EQ(row.exposure, 1.5);
  // Of larger pictures than the page shows, averages.
  const CodeImage small = read_row(source(), 0, 50).whole;
  EXPECT_LT(small.width, 30);
  EXPECT_NEAR(double(small.width) / small.height, double(columns) / lines, 0.1);
  double mean = 0, own = 0;
  for (const auto code : small.rgb) mean += code / double(small.rgb.size());
  for (const auto code : row.whole.rgb) own += code / double(row.whole.rgb.size());
  EXPECT_NEAR(mean, own, 1);
}

TEST_F(Figures, AreWrittenInEveryFormat) {
  for (const std::string_view format : figure_formats) {
    write_figure(source(), temp.path() / fmt::format("f{}", format));
  }
  const auto content = [&](const char* name) { return read_file(temp.path() / name, 1 << 26); };
  const std::string pdf = content("f.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF"));
  EXPECT_NE(pdf.find("/FontFile"), std::string::npos) << "fonts are embedded";
  const std::string svg = content("f.svg");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  std::size_t images = 0;
  for (std::size_t at = svg.find("<image"); at != std::string::npos;
       at = svg.find("<image", at + 1)) {
    ++images;
  }
  EXPECT_EQ(images, 10u);
  EXPECT_NE(svg.find("<symbol"), std::string::npos) << "letters are outlines";
  EXPECT_TRUE(content("f.png").starts_with("\x89PNG"));
  const std::string tex = content("f.tex");
  for (const char* wanted : {"\\toprule", "\\textbf{", "f-pieces/1-2-crop2.png", "+1.50 stops",
                             "f-pieces/convergence.pdf", "$\\times$"}) {
    EXPECT_NE(tex.find(wanted), std::string::npos) << wanted << '\n' << tex;
  }
  EXPECT_TRUE(std::filesystem::exists(temp.path() / "f-pieces/1-3-crop1.png"));
  EXPECT_TRUE(std::filesystem::exists(temp.path() / "f-pieces/1-1-error.png"));
}

TEST_F(Figures, AreSuggestedWhereMethodsDiffer) {
  const FigureSpec spec = suggest_figure(temp.path() / "a.sweep", "a.sweep");
  ASSERT_EQ(spec.scenes.size(), 2u);
  EXPECT_TRUE(spec.scenes[1].name.starts_with("Hall 2")) << spec.scenes[1].name;
  ASSERT_EQ(spec.methods.size(), 2u);
  EXPECT_EQ(spec.methods[1].name, "bdpt");
  ASSERT_EQ(spec.scenes[0].crops.size(), 2u);
  for (const auto& crop : spec.scenes[0].crops) EXPECT_GE(crop[0], columns / 2 - crop[2] / 2);
  EXPECT_EQ(spec.error_map, ErrorMetric::flip);
  // It is a file that can be drawn.
  const FigureSource again = source(write_document(spec));
  EXPECT_EQ(again.spec(), spec);
  EXPECT_GT(draw_figure(again).height, 100);
}

// Another program's picture without CPU seconds is shown, without an error at a CPU time.
TEST_F(Figures, ShowPicturesWithoutTheirTime) {
  const SweepFolder sweep = SweepFolder::create(temp.path() / "b.sweep", parse_sweep(R"({"job":
    {"scene": "door.glb", "reference": "r.exr", "resolution": [64, 48], "budget": {"iterations": 80}},
    "axes": {"/integrator": [{"type": "path", "max_depth": 6, "reuse": 16}, {"type": "bdpt", "max_depth": 6},
      {"type": "foreign", "name": "Cycles", "max_depth": 6, "pictures": [{"file": "o.exr", "seconds": 4}]}]},
    "compare_at": {"clock": "cpu_seconds"}})"));
  for (const SweepRun& run : sweep.plan().runs) finish(sweep, run, temp.path() / "r.exr");
  write_file_atomically(
      sweep.folder(sweep.plan().runs[2]).file("curve.csv"),
      "iteration,seconds,cpu_seconds,mae,rmse,mse,relmse,smape,flip,est_rmse,at_floor\n"
      ",4,,1,1,1,1,1,1,,0\n");
  const FigureSpec spec = suggest_figure(temp.path() / "b.sweep", "b.sweep");
  ASSERT_EQ(spec.methods.size(), 3u);
  EXPECT_EQ(spec.methods[0].name, "path (reuse 16)");
  EXPECT_EQ(spec.methods[1].name, "bdpt");
  EXPECT_EQ(spec.methods[2].name, "Cycles");
  const FigureSource figure = source(write_document(spec));
  EXPECT_TRUE(figure.error(0, 0, 0));
  EXPECT_FALSE(figure.error(0, 2, 0));
  EXPECT_TRUE(figure.picture(0, 2));
  const auto& warnings = figure.answers().warnings;
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& w) {
    return w.starts_with("1 of 3 runs (such as 0003-1) have no CPU seconds");
  }));
}

// Its name stays the program's where nothing but its pictures differs.
TEST_F(Figures, NameAnotherProgramInEachOfItsCells) {
  const SweepFolder sweep = SweepFolder::create(temp.path() / "b.sweep", parse_sweep(R"({"job":
    {"scene": "door.glb", "reference": "r.exr", "resolution": [64, 48], "budget": {"iterations": 80}},
    "axes": {"/integrator": [
      {"type": "foreign", "name": "Cycles", "pictures": [{"file": "o.exr", "seconds": 4}]},
      {"type": "foreign", "name": "Cycles", "pictures": [{"file": "p.exr", "seconds": 4}]}]}})"));
  for (const SweepRun& run : sweep.plan().runs) finish(sweep, run, temp.path() / "r.exr");
  const FigureSpec spec = suggest_figure(temp.path() / "b.sweep", "b.sweep");
  ASSERT_EQ(spec.methods.size(), 2u);
  for (const FigureMethod& method : spec.methods) EXPECT_EQ(method.name, "Cycles");
}

TEST_F(Figures, WithoutWhatTheyNameAreRefused) {
  expect_problem("a.sweep", "b.sweep", "/sweep", "found \"b.sweep\"");
  expect_problem("[40, 30, 16, 12]", "[50, 30, 16, 12]", "/scenes/0/crops/1",
                 "found [50, 30, 16, 12]; allowed: a rectangle inside the picture, 64 x 48");
  expect_problem("[40, 30, 16, 12]", "[40, 30, 16, 16]", "/scenes/0/crops/1",
                 "allowed: the aspect ratio of the first, 16 x 12");
  expect_problem(R"("/scene": "door.glb")", R"("/camera": "x")", "/scenes/0/settings",
                 R"(found "/camera", which the sweep does not vary; allowed: "/integrator/type")");
  expect_problem(R"("BDPT", "settings": {"/integrator/type": "bdpt"})",
                 R"("BDPT", "settings": {"/integrator/type": "vcm"})", "/methods/1/settings",
                 "no cell of these scenes has these settings");
  expect_problem("relmse", "psnr", "/metrics/0", "psnr");
  expect_problem(R"("error_map": "flip")", R"("error_map": "est_rmse")", "/error_map",
                 "allowed: a metric that needs a reference");
  expect_problem(R"("error_map")", R"("eror_map")", "/eror_map", "error_map");
}

TEST_F(Figures, OfJobsThatAreNotThereAreRefused) {
  const char* of_jobs =
      R"({"scenes": [{"name": "a"}], "methods": [{"name": "b", "jobs": [JOBS]}]})";
  const auto problem = [&](const std::string& jobs) {
    std::string spec = of_jobs;
    spec.replace(spec.find("JOBS"), 4, jobs);
    try {
      source(spec);
    } catch (const BadJob& bad) {
      return std::string(bad.what());
    }
    return std::string("no problem");
  };
  EXPECT_NE(
      problem(R"("a.sweep/runs/0001-1", "nothing")").find("/methods/0/jobs/1: found \"nothing\""),
      std::string::npos);
  EXPECT_NE(problem("").find("/methods/0/jobs: found none"), std::string::npos);
  EXPECT_NE(problem(R"("20200101-000000-nobody")").find("the id of a job"), std::string::npos);
  // Two methods under one name.
  EXPECT_NE(
      problem(R"("a.sweep/runs/0001-1", "a.sweep/runs/0003-1")").find("2 cells of scene \"a\""),
      std::string::npos);
  // Not rendered yet.
  JobSpec waiting;
  waiting.scene = "a.glb";
  JobFolder::create(temp.path() / "waiting", waiting);
  EXPECT_NE(problem(R"("waiting")").find("no run of this picture is done"), std::string::npos);
  expect_problem(R"("BDPT", "settings": {"/integrator/type": "bdpt"})", R"("BDPT", "jobs": ["a"])",
                 "/methods/1/jobs", "beside \"sweep\"");
}

TEST_F(Figures, HaveNamesOfWholeCharacters) {
  std::string name, spec = sweep_json;
  for (int i = 0; i < 70; ++i) name += "ä";
  spec.replace(spec.find("door"), 4, name);
  const SweepFolder sweep = SweepFolder::create(temp.path() / "b.sweep", parse_sweep(spec));
  for (const SweepRun& run : sweep.plan().runs) finish(sweep, run, temp.path() / "r.exr");
  const FigureSpec suggested = suggest_figure(temp.path() / "b.sweep", "b.sweep");
  EXPECT_EQ(suggested.scenes[0].name, name.substr(0, 120)) << "60 characters of two bytes";
  EXPECT_EQ(source(write_document(suggested)).spec().scenes[0].name, name.substr(0, 120));
}

TEST(FigurePictures, AreJpegsUnlessTheyAreToBeExact) {
  Drawing d{100, 100, "", "Linux Biolinum O", 95, {}};
  CodeImage noise{200, 200, {}};
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 3 * 200 * 200; ++i) {
    noise.rgb.push_back(static_cast<std::uint8_t>(255 * rng.next()));
  }
  d.add(ImageMark{0, 0, 100, 100, noise});
  const std::string small = draw_pdf(d);
  EXPECT_NE(small.find("/DCTDecode"), std::string::npos);
  d.jpeg_quality = 0;
  const std::string exact = draw_pdf(d);
  EXPECT_EQ(exact.find("/DCTDecode"), std::string::npos);
  EXPECT_GT(exact.size(), small.size());
}

TEST(FigureNumbers, HaveThreeDigits) {
  EXPECT_EQ(figure_number(0.0123456), "0.0123");
  EXPECT_EQ(figure_number(9.996), "10.0");
  EXPECT_EQ(figure_number(1234.5), "1234");
  EXPECT_EQ(figure_number(0), "0");
  EXPECT_EQ(figure_number(1.5e-7), "1.50 · 10⁻⁷");
  EXPECT_EQ(figure_number(9.999e6), "1.00 · 10⁷");
  EXPECT_EQ(latex_text("50 % of 2_3 · 10⁻⁷"), "50 \\% of 2\\_3$\\cdot$10$^{-}$$^7$");
  EXPECT_EQ(latex_text("> 8 s, {a}^2 ~ \\ −1"),
            "$>$ 8 s, \\{a\\}\\textasciicircum{}2 \\textasciitilde{} "
            "\\textbackslash{} $-$1");
}

TEST(LogAxis, HasTicksThatDoNotTouch) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {0.1, 10}, {0.9, 1.3}, {0.02, 0.9}, {1e-7, 1e3}, {3, 40}}) {
    const LogAxis axis{low, high, 0, 120};
    double before = -1e9;
    int labels = 0;
    for (const AxisTick& t : log_ticks(axis, 12)) {
      EXPECT_GE(t.value, low * 0.999);
      EXPECT_LE(t.value, high * 1.001);
      if (t.label.empty()) continue;
      EXPECT_GE(axis.at(t.value) - before, 12 - 1e-9);
      before = axis.at(t.value);
      ++labels;
    }
    EXPECT_GE(labels, 2) << low << ' ' << high;
    EXPECT_LE(labels, 10);
  }
}

}  // namespace
}  // namespace lacuna
