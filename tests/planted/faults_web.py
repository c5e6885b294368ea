"""Faults in the page."""

from fault import Fault

NUMBERS = ("tests/web/numbers.test.mjs",)
DOM = ("tests/web/dom.test.mjs",)
LIST = ("tests/web/list.test.mjs",)
PAGE = ("tests/web/page.test.mjs",)
PICTURES = ("tests/web/pictures.test.mjs",)
VIEWER = ("tests/web/viewer.test.mjs", "tests/web/viewer_pairs.test.mjs")
ANSWERS = ("tests/web/answers.test.mjs",)

FAULTS = [
    # Numbers and texts.
    Fault("a job is posted again without its zeros", "web/format.js",
          "(value === null ? undefined : value)", "(value || undefined)", NUMBERS),
    Fault("instants are shown in UTC", "web/format.js",
          "new Date(date - 60_000 * date.getTimezoneOffset())", "new Date(date)", NUMBERS),
    Fault("the smaller unit of a duration is rounded up", "web/format.js",
          "Math.floor((s % large[0]) / small[0])", "Math.ceil((s % large[0]) / small[0])", NUMBERS),
    Fault("an error that is reached exactly is not reached", "web/curve.js",
          "curve.findLastIndex((p) => p.y > y) + 1", "curve.findLastIndex((p) => p.y >= y) + 1", NUMBERS),
    Fault("render times are compared by their difference", "web/curve.js",
          "most <= mostApart * least", "most <= mostApart + least", NUMBERS),
    Fault("jobs of equal names get the same suffix", "web/curve_panel.js",
          'job.id.split("-").pop()', 'job.id.split("-")[0]', PAGE),
    Fault("the slowest job is the fastest", "web/view_compare.js",
          "significant(times[i] / fastest)", "significant(fastest / times[i])", PAGE),
    Fault("threads that wait include the one at work", "web/report.js",
          "s.serial * (count - 1) + s.waiting", "s.serial * count - s.waiting", PAGE),
    # Elements, addresses, requests.
    Fault("elements that moved stay where they were", "web/dom.js",
          "if (kept !== there) old.insertBefore(kept, there);", "if (!there) old.append(kept);", DOM),
    Fault("an update takes what is being typed", "web/dom.js",
          'const typed = old === document.activeElement && old.matches("input:not([type=checkbox])");',
          "const typed = false;", DOM),
    Fault("addresses have escaped commas", "web/dom.js", '.replaceAll("%2C", ",")', "", DOM),
    Fault("a question that is answered by no is a yes", "web/dom.js",
          'resolve(dialog.returnValue === "yes");', "resolve(true);", DOM),
    Fault("a part of a file is a byte too long", "web/api.js",
          "`bytes=${offset}-${offset + bytes - 1}`", "`bytes=${offset}-${offset + bytes}`", VIEWER),
    # The list and a job.
    Fault("the first row of a page is number 0", "web/view_jobs.js",
          "jobs.length && here.from + 1}", "jobs.length && here.from}", LIST),
    Fault("a removed job stays selected", "web/view_jobs.js",
          "if (chosen.delete(id)) draw();", "if (chosen.has(id)) draw();", LIST),
    Fault("an answer to an earlier filter replaces the list", "web/view_jobs.js",
          "if (mine !== asked) return;", "if (mine > asked) return;", LIST),
    Fault("the tail of a log begins within a line", "web/view_job.js",
          'begin > 0 ? lines.slice(lines.indexOf("\\n") + 1) : lines', "lines", PAGE),
    # Sweeps.
    Fault("a gain that may be 1 is called worse", "web/answers.js",
          '!gain?.at_least && gain?.high < 1 ? "worse"', '!gain?.at_least && gain?.low < 1 ? "worse"', ANSWERS),
    Fault("settings are sorted by their digits", "web/answers.js",
          'localeCompare(settingText(b), "en", { numeric: true })', 'localeCompare(settingText(b), "en")', ANSWERS),
    # Pictures.
    Fault("a reference has the picture's scale", "web/errors.js",
          "r[k] * reference.scale", "r[k] * image.scale", PICTURES),
    Fault("a crop has the rows of its own width", "web/pixels.js",
          "const first = ((y + row) * image.width + x) * n;", "const first = ((y + row) * w + x) * n;", PICTURES),
    Fault("blocks at the border are divided as whole ones", "web/pixels.js",
          "sum / side(width, block % w) / side(height, Math.floor(block / w))", "sum / n / n", NUMBERS),
    Fault("a stop up is darker", "web/paint.js", "(look.high - look.low) * 2 ** -stops",
          "(look.high - look.low) * 2 ** stops", PICTURES),
    Fault("points at the reference's noise are filled", "web/figure.js",
          "mark(index, place(p), p.floor)", "mark(index, place(p), false)", PICTURES),
    Fault("zoom has no end", "web/viewport.js",
          "const next = Math.min(largestZoom, zoom);", "const next = zoom;", NUMBERS),
    Fault("before the first layer there is none", "web/viewer_controls.js",
          "options[(at + by + options.length) % options.length]", "options[(at + by) % options.length]", PICTURES),
    Fault("paths are seen upside down", "web/pixel_paths.js", "[0, 2, 1], [0, 1, -1]]", "[0, 2, 1], [0, 1, 1]]",
          ("tests/web/paper_figure.test.mjs",)),
]
