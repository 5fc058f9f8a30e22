# SPDX-License-Identifier: BSD-3-Clause
# Draws a sensor's columns and the paper's mask (its figures 1 and 2), of two scans by mask_cells:
#   gnuplot -e "first='a.txt'; second='b.txt'; stem='mask'" mask.gp
name(file) = system("sed -n 's/^# scan \\([^ ]*\\) .*/\\1/p' " . file)
field(file, key) = real(system("sed -n 's/^#.* " . key . " \\([0-9.]*\\).*/\\1/p' " . file))
set style line 1 linecolor rgb "#c8c8c8" pointtype 7 pointsize 0.45  # other returns
set style line 2 linecolor rgb "#0072B2" pointtype 7 pointsize 0.6   # neighbours in the mask
set style line 3 linecolor rgb "#D55E00" pointtype 7 pointsize 0.6   # neighbours that it misses
set style line 4 linecolor rgb "#000000" pointtype 3 pointsize 1.4 linewidth 2  # the return
set border 3
set tics nomirror
set datafile missing NaN
unset key
is(what, kind, x) = what == kind ? x : NaN
span = 22  # steps and lasers shown
do for [format in "png svg"] {
  if (format eq "png") { set terminal pngcairo noenhanced size 1000,900 font ",11" background "#ffffff" }
  if (format eq "svg") { set terminal svg noenhanced size 1000,900 font ",11" background "#ffffff" }
  set output stem . "." . format
  set multiplot layout 2,2 margins 0.07,0.98,0.16,0.95 spacing 0.1,0.13
  do for [file in first . " " . second] {
    sigma = field(file, "sigma"); lambda = field(file, "lambda")
    set title sprintf("%s: cells and the paper's mask", name(file))
    set xlabel "steps from the return"
    set ylabel "lasers from the return, downwards"
    set xrange [-span:span]; set yrange [span:-span]
    set object 1 rectangle from -sigma-0.5,-lambda-0.5 to sigma+0.5,lambda+0.5 \
      fillstyle empty border rgb "#E69F00" linewidth 2
    plot file using (is($1, 3, $2)):3 linestyle 1 title "returns", \
         file using (is($1, 1, $2)):3 linestyle 2 title "neighbours", \
         file using (is($1, 2, $2)):3 linestyle 3 title "neighbours outside the mask", \
         file using (is($1, 0, $2)):3 linestyle 4 title "the return"
    unset object 1
    set title sprintf("%s: directions, a column joined", name(file))
    set xlabel "azimuth from the return, degrees"
    set ylabel "elevation from the return, degrees"
    set xrange [-10:10]; set yrange [-10:10]
    if (file eq second) { set key at screen 0.6,0.005 center bottom samplen 1 }
    plot file using (is($1, 3, $4)):5 linestyle 1 title "returns", \
         file using ($2 == 0 ? $4 : NaN):5 \
           with linespoints linecolor rgb "#009E73" pointtype 7 pointsize 0.5 notitle, \
         file using (is($1, 1, $4)):5 linestyle 2 title "neighbours", \
         file using (is($1, 2, $4)):5 linestyle 3 title "neighbours outside the mask", \
         file using (is($1, 0, $4)):5 linestyle 4 title "the return"
  }
  unset key
  unset multiplot
  unset output
}
