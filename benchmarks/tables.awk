# SPDX-License-Identifier: BSD-3-Clause
# Tables of the documents, made of files by `lisco_compare --csv` and literal_mask; -v table=NAME chooses one.
# Names of scans contain no commas.
BEGIN { FS = "," }
FNR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
{ gsub(/"/, "", $1) }

function field(name) { return $column[name] }
function key(baseline) { return $1 SUBSEP field("tolerance") SUBSEP baseline }

table != "mask" {
  scan = $1; tolerance = field("tolerance"); baseline = field("baseline")
  if (!(scan in returns)) { returns[scan] = field("returns"); scans[++scan_count] = scan }
  if (!((scan, tolerance) in clusters)) { ++cases; case_scan[cases] = scan; case_tolerance[cases] = tolerance }
  if (!(tolerance in seen)) { seen[tolerance] = 1; tolerances[++tolerance_count] = tolerance }
  clusters[scan, tolerance] = field("reference_clusters")
  # Of a case that was measured more than once, the least time counts: disturbances only add time.
  if (!(key(baseline) in least) || field("min_ms") < least[key(baseline)]) least[key(baseline)] = field("min_ms")
  if ((key(baseline) in median) && median[key(baseline)] <= field("median_ms")) next
  mean[key(baseline)] = field("mean_ms"); error[key(baseline)] = field("confidence99_ms")
  median[key(baseline)] = field("median_ms"); cold[key(baseline)] = field("cold_median_ms")
  lower[key(baseline)] = field("lower_quartile_ms"); upper[key(baseline)] = field("upper_quartile_ms")
  cells[scan] = field("rows") * field("columns")
  identical[key(baseline)] = field("identical")
  objects[scan, tolerance] = field("objects"); whole[scan, tolerance] = field("whole")
  split_[scan, tolerance] = field("split"); merged[scan, tolerance] = field("merged")
  missed[scan, tolerance] = field("missed")
}

# Three significant digits.
function short(value) {
  return value >= 100 ? sprintf("%.0f", value) : value >= 10 ? sprintf("%.1f", value) : sprintf("%.2f", value)
}
function ratio(values, scan, tolerance, slow, fast) {
  return values[scan, tolerance, slow] / values[scan, tolerance, fast]
}

# Geometric mean and lowest of slow's time over fast's, for the line below a table.
function summary(slow, fast,   i, sum, cold_sum, r, lowest) {
  lowest = 1e30
  for (i = 1; i <= cases; ++i) {
    r = ratio(median, case_scan[i], case_tolerance[i], slow, fast)
    sum += log(r); if (r < lowest) lowest = r
    cold_sum += log(ratio(cold, case_scan[i], case_tolerance[i], slow, fast))
  }
  return sprintf("geometric mean %s, lowest %s; of first runs, with cold memory, %s", short(exp(sum / cases)),
                 short(lowest), short(exp(cold_sum / cases)))
}

# Half the distance between the quartiles, in percent of the median.
function spread(s, t, baseline) {
  return sprintf("%.0f%%", 50 * (upper[s, t, baseline] - lower[s, t, baseline]) / median[s, t, baseline])
}

function benchmarks(   i, s, t) {
  printf "%-18s %8s %5s %8s %9s %4s %9s %4s %9s %4s %10s %10s  %s\n", "scan", "returns", "eps", "clusters",
         "PCL ms", "+-", "grid ms", "+-", "Lisco ms", "+-", "PCL/Lisco", "grid/Lisco", "identical"
  for (i = 1; i <= cases; ++i) {
    s = case_scan[i]; t = case_tolerance[i]
    printf "%-18s %8d %5.2f %8d %9.2f %4s %9.3f %4s %9.3f %4s %10.1f %10.2f  %s\n", s, returns[s], t, clusters[s, t],
           median[s, t, "pcl"], spread(s, t, "pcl"), median[s, t, "grid"], spread(s, t, "grid"),
           median[s, t, "lisco"], spread(s, t, "lisco"), ratio(median, s, t, "pcl", "lisco"),
           ratio(median, s, t, "grid", "lisco"), identical[s, t, "lisco"]
  }
  printf "PCL / Lisco in %d cases: %s\n", cases, summary("pcl", "lisco")
  printf "grid / Lisco in %d cases: %s\n", cases, summary("grid", "lisco")
}

# Lisco's time over the number of cells. Scans of a series are called SERIES_NUMBER, smallest first. "doubling" is the
# ratio of the fastest runs per doubling of the cells: on a shared machine long runs are disturbed more often.
function growth(   i, s, t, series, before, factor, doublings, sum, count, highest) {
  printf "%-22s %9s %9s %5s %8s %9s %4s %9s %8s  %s\n", "scan", "cells", "returns", "eps", "clusters", "Lisco ms",
         "+-", "fastest", "doubling", "identical"
  for (i = 1; i <= cases; ++i) {
    s = case_scan[i]; t = case_tolerance[i]
    factor = "-"
    if (i > 1 && substr(s, 1, length(series)) == series) {
      doublings = log(cells[s] / cells[before]) / log(2)
      factor = exp(log(least[s, t, "lisco"] / least[before, t, "lisco"]) / doublings)
      sum += log(factor); ++count
      if (factor > highest) highest = factor
      factor = sprintf("%.2f", factor)
    }
    series = s; sub(/[0-9]+$/, "", series); before = s
    printf "%-22s %9d %9d %5.2f %8d %9.3f %4s %9.3f %8s  %s\n", s, cells[s], returns[s], t, clusters[s, t],
           median[s, t, "lisco"], spread(s, t, "lisco"), least[s, t, "lisco"], factor, identical[s, t, "lisco"]
  }
  printf "time per doubling of the cells: geometric mean %.2f, highest %.2f; at most 2.3 is wanted\n",
         exp(sum / count), highest
}

# One row per scan, one column per tolerance: PCL's time, Lisco's time, and their ratio.
function readme(   i, j, s, t) {
  printf "| scan | returns |"
  for (j = 1; j <= tolerance_count; ++j) if (wanted(tolerances[j])) printf " %g m |", tolerances[j]
  printf "\n|---|---|"
  for (j = 1; j <= tolerance_count; ++j) if (wanted(tolerances[j])) printf "---|"
  print ""
  for (i = 1; i <= scan_count; ++i) {
    s = scans[i]
    printf "| %s | %d |", s, returns[s]
    for (j = 1; j <= tolerance_count; ++j) {
      t = tolerances[j]
      if (!wanted(t)) continue
      printf " %s → %s (%s×) |", short(median[s, t, "pcl"]), short(median[s, t, "lisco"]),
             short(ratio(median, s, t, "pcl", "lisco"))
    }
    print ""
  }
  printf "\nOver %d cases (all tolerances): %s.\n", cases, summary("pcl", "lisco")
}
function wanted(tolerance) { return tolerance == 0.1 || tolerance == 0.4 || tolerance == 1 }

# Mean time of each baseline with its confidence, and the ratio of PCL's mean, with KdTree (false), to it.
function times(   i, s, t) {
  printf "| scan | returns | ε | clusters | PCL | PCL, octree | paper's Lisco | grid | Lisco |"
  print " PCL / octree | PCL / paper's | PCL / grid | PCL / Lisco |"
  print "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
  for (i = 1; i <= cases; ++i) {
    s = case_scan[i]; t = case_tolerance[i]
    printf "| %s | %d | %g | %d | %s | %s | %s%s | %s | %s |", s, returns[s], t, clusters[s, t], timed(s, t, "pcl"),
           timed(s, t, "pcl-octree"), timed(s, t, "paper"), identical[s, t, "paper"] == "yes" ? "" : " *",
           timed(s, t, "grid"), timed(s, t, "lisco")
    printf " %s | %s | %s | %s |\n", short(ratio(mean, s, t, "pcl", "pcl-octree")),
           short(ratio(mean, s, t, "pcl", "paper")), short(ratio(mean, s, t, "pcl", "grid")),
           short(ratio(mean, s, t, "pcl", "lisco"))
  }
  printf "\nGeometric means of the ratios to PCL: octree %s, paper's Lisco %s, grid %s, Lisco %s;\n",
         overall("pcl-octree"), overall("paper"), overall("grid"), overall("lisco")
  printf "lowest: %s, %s, %s, %s.\n",
         lowest_of("pcl-octree"), lowest_of("paper"), lowest_of("grid"), lowest_of("lisco")
}
function overall(baseline,   i, sum) {
  for (i = 1; i <= cases; ++i) sum += log(ratio(mean, case_scan[i], case_tolerance[i], "pcl", baseline))
  return short(exp(sum / cases))
}
function lowest_of(baseline,   i, r, lowest) {
  lowest = 1e30
  for (i = 1; i <= cases; ++i) {
    r = ratio(mean, case_scan[i], case_tolerance[i], "pcl", baseline)
    if (r < lowest) lowest = r
  }
  return short(lowest)
}
function timed(s, t, baseline) { return short(mean[s, t, baseline]) " ± " short(error[s, t, baseline]) }

# How clusters cover the true objects.
function scored(   i, j, s, t) {
  printf "| eps |"
  for (i = 1; i <= scan_count; ++i) printf " %s |", scans[i]
  printf "\n|---|"
  for (i = 1; i <= scan_count; ++i) printf "---|"
  printf "\n| objects |"
  for (i = 1; i <= scan_count; ++i) printf " %d |", objects[scans[i], tolerances[1]]
  print ""
  for (j = 1; j <= tolerance_count; ++j) {
    t = tolerances[j]
    printf "| %g |", t
    for (i = 1; i <= scan_count; ++i) {
      s = scans[i]
      printf " %d / %d / %d / %d |", whole[s, t], split_[s, t], merged[s, t], missed[s, t]
    }
    print ""
  }
}

function counts(   i, s, paper) {
  split("26891 16218 39028 18229 64518", paper, " ")
  print "| scene | returns in the paper | returns here | difference |\n|---|---|---|---|"
  for (i = 1; i <= scan_count; ++i) {
    s = scans[i]
    printf "| %s | %d | %d | %+.1f %% |\n", s, paper[i], returns[s], 100 * (returns[s] / paper[i] - 1)
  }
}

table == "mask" {
  scan = $1; t = field("tolerance")
  if (!(scan in returns)) { returns[scan] = field("returns"); scans[++scan_count] = scan }
  if (!(t in seen)) { seen[t] = 1; tolerances[++tolerance_count] = t }
  mislabelled[scan, t] = field("mislabelled"); destaggered[scan, t] = field("mislabelled_destaggered")
  pairs[scan, t] = field("pairs"); horizon[scan, t] = field("missed_horizon")
  columns[scan, t] = field("missed_columns"); lasers[scan, t] = field("missed_lasers")
}
function mask(   i, j, s, t, missed) {
  printf "| scan | returns |"
  for (j = 1; j <= tolerance_count; ++j) printf " %g m |", tolerances[j]
  for (j = 1; j <= 2; ++j) printf " missed pairs at %g m | by reason |", tolerances[j]
  printf "\n|"
  for (j = 1; j <= tolerance_count + 6; ++j) printf "---|"
  print ""
  for (i = 1; i <= scan_count; ++i) {
    s = scans[i]
    printf "| %s | %d |", s, returns[s]
    for (j = 1; j <= tolerance_count; ++j) {
      t = tolerances[j]
      printf " %d (%d) |", mislabelled[s, t], destaggered[s, t]
    }
    for (j = 1; j <= 2; ++j) {
      t = tolerances[j]
      missed = lasers[s, t] + horizon[s, t] + columns[s, t]
      printf " %s %% | %d / %d / %d |", percent(missed / pairs[s, t]), columns[s, t], horizon[s, t], lasers[s, t]
    }
    print ""
  }
}
# In percent, with two digits or more.
function percent(share) {
  return share >= 0.001 || share == 0 ? sprintf("%.2f", 100 * share) : sprintf("%.2g", 100 * share)
}

END {
  if (table == "benchmarks") benchmarks()
  if (table == "growth") growth()
  if (table == "readme") readme()
  if (table == "times") times()
  if (table == "scored") scored()
  if (table == "counts") counts()
  if (table == "mask") mask()
}
