# SPDX-License-Identifier: BSD-3-Clause
# Draws times over many rotations, by `evaluation_tables.py rotations-data`: their mean over the tolerance, and each
# rotation over its returns.
#   gnuplot -e "data='a.txt'; stem='real'; what='98 rotations'" rotations.gp
keys = "pcl grid paper lisco"
titles = "'PCL, KdTree (false)' 'voxel grid' 'Lisco as in the paper' 'Lisco for PCL'"
colors = "#000000 #0072B2 #E69F00 #D55E00"
marks = "5 10 9 13"
at(kind, key, x) = strcol(1) eq kind && strcol(2) eq key ? x : NaN
set datafile missing NaN
set border 3
set tics nomirror
set grid ytics xtics back linetype 1 linecolor rgb "#dcdcdc" linewidth 1
set logscale y
set format y "%g"
set ylabel "milliseconds"
unset key
do for [format in "png svg"] {
  if (format eq "png") { set terminal pngcairo noenhanced size 1100,520 font ",11" background "#ffffff" }
  if (format eq "svg") { set terminal svg noenhanced size 1100,520 font ",11" background "#ffffff" }
  set output stem . "." . format
  set multiplot layout 1,2 margins 0.07,0.98,0.24,0.92 spacing 0.09
  set title sprintf("%s: mean with 99%% confidence", what)
  set xlabel "tolerance, metres"
  unset logscale x
  set xrange [0.25:0.75]
  plot for [i = 1:4] data using (at("mean", word(keys, i), $3)):4:5 with yerrorlines \
    linewidth 2 pointtype int(word(marks, i)) pointsize 0.8 linecolor rgb word(colors, i) title word(titles, i)
  set title sprintf("%s: each, tolerance 0.4 m", what)
  set xlabel "thousands of returns"
  set logscale x
  set xtics ("5" 5e3, "7" 7e3, "10" 1e4, "15" 15e3, "20" 2e4, "25" 25e3, "30" 3e4, "35" 35e3, "40" 4e4, "50" 5e4, \
    "70" 7e4, "100" 1e5, "150" 15e4, "200" 2e5)
  set xrange [*:*] noextend
  set offsets graph 0.03, graph 0.03
  set key at screen 0.85,0.005 bottom horizontal maxrows 1 samplen 1.5
  plot for [i = 1:4] data using (at("each", word(keys, i), $3)):4 with points \
    pointtype int(word(marks, i)) pointsize 0.7 linecolor rgb word(colors, i) title word(titles, i)
  unset key
  set xtics autofreq
  unset multiplot
  unset output
}
