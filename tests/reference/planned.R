# Reference values for analysis/report/planned: run with Rscript, writes planned.csv beside itself.
# The small study of tests/analysis/study_file.c: person i of 22; cell 1 (epsilon 0.2): i <= 6 chose the test option;
# cell 2 (epsilon 0.05) of persons 1 to 19: i <= 4; both with i %% 7 toggles and after i / 2 seconds. Ratings first and
# second as in small_study.R. "hand" is a factor between people: odd and even i. Margin of equivalence 0.2, with the
# 90 % interval. A line: plan and row, estimate, interval, p, Holm's p over all rows of the study, those of equality too,
# of which and of the row before one hypothesis at most is true (Shaffer 1986); NA where there is none. The lines "even" are of the same study with 11 of 22 and 9 of 19 for the test option.
i <- 1:22
k1 <- as.numeric(i <= 6); k2 <- ifelse(i <= 19, as.numeric(i <= 4), NA)
first <- c(6, 7, 5, 8, 6, 4, 6, 7, 9, 6, 6, 6, 9, 5, 8, 6, 4, 7, 6, 6)
change <- c(1, 1, 1, 1, 1, 1, 1, -1, -1, 0, 0, -2, -2, -1, -1, -1, -1, 0, 0, 0)
# exact sign flip of whole numbers d: all sums by convolution
flip <- function(d) {
  d <- abs(d[d != 0]); size <- sum(d); p <- c(rep(0, size), 1, rep(0, size))
  for (x in d) { up <- c(rep(0, x), head(p, -x)); down <- c(tail(p, -x), rep(0, x)); p <- (up + down) / 2 }
  p
}
flip_p <- function(d) { p <- flip(d); s <- seq_along(p) - (length(p) + 1) / 2; sum(p[abs(s) >= abs(sum(d))]) }
rows <- list()
add <- function(name, estimate, low, high, p) rows[[length(rows) + 1]] <<- list(name, c(estimate, low, high, p))
of_t <- function(name, t, p = t$p.value) add(name, if (length(t$estimate) == 2) -diff(t$estimate) else t$estimate,
                                            t$conf.int[1], t$conf.int[2], p)
b1 <- binom.test(6, 22); b2 <- binom.test(4, 19)
tost <- function(k, n, margin = 0.2) max(binom.test(k, n, 0.5 - margin, "greater")$p.value,
                                         binom.test(k, n, 0.5 + margin, "less")$p.value)
equality <- function(name, k, n, margin = 0.2) {
  ends <- binom.test(k, n, conf.level = 0.9)$conf.int
  add(name, k / n, ends[1], ends[2], tost(k, n, margin))
}
add("binomial choice cell 0.2", 6 / 22, b1$conf.int[1], b1$conf.int[2], b1$p.value)
equality("equality cell 0.2", 6, 22)
add("binomial choice cell 0.05", 4 / 19, b2$conf.int[1], b2$conf.int[2], b2$p.value)
equality("equality cell 0.05", 4, 19)
n <- ifelse(i <= 19, 2, 1); k <- k1 + ifelse(is.na(k2), 0, k2)
of_t("binomial choice study", t.test(k / n, mu = 0.5), flip_p(2 * k - n))
of_t("mean toggles study", t.test(i %% 7), NA)
of_t("mean reaction cell 0.2", t.test(i / 2), NA)
of_t("mean reaction cell 0.05", t.test((1:19) / 2), NA)
of_t("paired_t choice factor", t.test(k1[1:19], k2[1:19], paired = TRUE))
f <- t.test(k1[1:19] - k2[1:19])
add("anova choice factor", f$statistic^2 / (f$statistic^2 + 18), NA, NA, pf(f$statistic^2, 1, 18, lower.tail = FALSE))
of_t("paired_t rating order test", t.test(change[1:11]))
of_t("paired_t rating order regular", t.test(change[12:20]))
of_t("unpaired_t rating order", t.test(first[12:20], first[1:11]))
# In ascending order each p times the largest number of hypotheses of those left that can be true together.
holm_of <- function(rows) {
  p <- sapply(rows, function(r) r[[2]][4])
  claim <- cumsum(!grepl("equality", sapply(rows, `[[`, 1)))
  out <- rep(NA, length(p)); most <- 0
  for (i in order(p, na.last = NA)) {
    left <- !is.na(p) & is.na(out)
    most <- max(most, min(1, length(unique(claim[left])) * p[i])); out[i] <- most
  }
  out
}
holm <- holm_of(rows)
line <- function(r, h) paste(c(r[[1]], sprintf("%.17g", c(r[[2]], h))), collapse = ",")
out <- mapply(line, rows, holm)
odd <- i %% 2 == 1; w <- t.test(i[odd] / 2, i[!odd] / 2)
rows <- list(); of_t("unpaired_t reaction factor odd", w)
out <- c(out, line(rows[[1]], w$p.value))
out <- c(out, sprintf("margin cell %s,%.17g", c("0.2", "0.05"), c(tost(6, 22), tost(4, 19))))
even <- function(name, margin, alternative = "two.sided")
  for (cell in list(list("0.2", 11, 22), list("0.05", 9, 19))) {
    b <- binom.test(cell[[2]], cell[[3]], alternative = alternative)
    add(paste(name, margin, "cell", cell[[1]]), cell[[2]] / cell[[3]], b$conf.int[1], b$conf.int[2], b$p.value)
    equality(paste(name, margin, "equality", cell[[1]]), cell[[2]], cell[[3]], margin)
  }
for (margin in c(0.2, 0.25, 0.3)) {
  rows <- list()
  even("even", margin)
  out <- c(out, mapply(line, rows, holm_of(rows)))
}
# "both": planned with two margins. "rated": the same among more that was planned. "less": one-sided tests of a difference, which do not exclude one beyond
# the margin, so that all four count.
rows <- list()
even("both", 0.3)
even("both", 0.25)
out <- c(out, mapply(line, rows, holm_of(rows)))
rows <- list()
even("rated", 0.25)
of_t("rated 0.25 paired_t rating order test", t.test(change[1:11]))
of_t("rated 0.25 paired_t rating order regular", t.test(change[12:20]))
out <- c(out, mapply(line, rows, holm_of(rows)))
rows <- list()
even("less", 0.25, "less")
out <- c(out, mapply(line, rows, p.adjust(sapply(rows, function(r) r[[2]][4]), "holm")))
# Nine choices of each person in one cell (study_desc.several): people are tested.
shares <- ((i <= 6) + pmin(8, (5 * i) %% 9)) / 9
rows <- list()
of_t("several cell 0.2", t.test(shares, mu = 0.5), flip_p(round(18 * shares) - 9))
ends <- t.test(shares, conf.level = 0.9)$conf.int
add("several equality 0.2", mean(shares), ends[1], ends[2], max(t.test(shares, mu = 0.4, alternative = "greater")$p.value,
                                                                t.test(shares, mu = 0.6, alternative = "less")$p.value))
b <- binom.test(4, 19)
add("several cell 0.05", 4 / 19, b$conf.int[1], b$conf.int[2], b$p.value)
equality("several equality 0.05", 4, 19, 0.1)
out <- c(out, mapply(line, rows, holm_of(rows)))
# Toggles (70 i + 7 cell) %% 11. Strays: of persons 1 to 14 the odd were to see cell 1 alone and the even cell 2, of 15 to
# 22 both, 20 to 22 with no valid answer in cell 2; who has both is left out. Dropouts: all were to see both, persons 9 to
# 22 stopped before cell 2.
a <- (70 * i + 7) %% 11; b <- (70 * i + 14) %% 11
rows <- list()
of_t("strays unpaired_t toggles", t.test(a[(i <= 14 & odd) | i >= 20], b[i <= 14 & !odd]))
out <- c(out, line(rows[[1]], rows[[1]][[2]][4]))
rows <- list()
of_t("dropouts paired_t toggles", t.test((a - b)[1:8]))
f <- t.test((a - b)[1:8])
add("dropouts anova toggles", f$statistic^2 / (f$statistic^2 + 7), NA, NA, pf(f$statistic^2, 1, 7, lower.tail = FALSE))
out <- c(out, mapply(line, rows, holm_of(rows)))
writeLines(c("row,estimate,low,high,p,holm", gsub("NA", "nan", out)), "planned.csv")
