# Reference values for analysis/image: run with Rscript, writes image_measures.csv beside itself (name,value). Everything is
# computed in double precision straight from the papers' equations, with filters in two dimensions and no shortcuts:
# weighted PSNR (Geisler & Perry 1998), SSIM (Wang et al. 2004), LDR-FLIP (Andersson et al. 2020), and the two
# measures of flicker as their headers define them. The pictures are those of tests/analysis/formula.c.
W <- 48
H <- 40
X <- matrix(rep(0:(W - 1), each = H), H, W) # [row, column], from 0
Y <- matrix(rep(0:(H - 1), W), H, W)
clamp <- function(v, low, high) pmin(pmax(v, low), high)

# --- pictures ---
hash <- function(c, t) {
  h <- (X * 7919 + Y * 10007 + c * 3571 + t * 15013 + 12345) %% 65537
  h <- (h * h + 77) %% 65537
  (h * h) %% 65537
}
reference_picture <- function(t) lapply(0:2, function(c)
  clamp(96 + 60 * ((X %/% 8 + Y %/% 6) %% 2) + (X * (c + 2)) %% 37 - (Y * (4 - c)) %% 29 + hash(c, t) %% 9, 0, 255))
test_picture <- function(t) {
  p <- reference_picture(t)
  patch <- X >= 20 & X < 30 & Y >= 10 & Y < 18
  lapply(0:2, function(c) {
    v <- p[[c + 1]] + ifelse(X < 24, hash(c + 3, t) %% 41 - 20, hash(c + 3, t) %% 11 - 5)
    clamp(v + ifelse(patch, c(70, 0, -70)[c + 1], 0), 0, 255)
  })
}

# --- eccentricity: tangents of the frustum, gaze at (7, -4) degrees ---
tan_left <- 1.1; tan_right <- 0.9; tan_down <- 0.8; tan_up <- 0.9
deg <- pi / 180
gaze <- c(sin(7 * deg) * cos(-4 * deg), sin(-4 * deg), -cos(7 * deg) * cos(-4 * deg))
U <- (X + 0.5) / W * (tan_left + tan_right) - tan_left
V <- tan_up - (Y + 0.5) / H * (tan_down + tan_up)
E <- acos((U * gaze[1] + V * gaze[2] - gaze[3]) / sqrt(U^2 + V^2 + 1)) / deg
weight <- (2.3 / (E + 2.3))^2
rings <- list("0-5" = E < 5, "5-15" = E >= 5 & E < 15, "15-30" = E >= 15 & E < 30, "30+" = E >= 30,
              whole = E >= 0)

lines <- c()
put <- function(name, value) lines <<- c(lines, sprintf("%s,%.17g", name, value))
put_rings <- function(name, map, counts = !is.na(map))
  for (r in names(rings)) put(paste(name, r, sep = "."), mean(map[rings[[r]] & counts]))

# --- error ---
a <- test_picture(0)
b <- reference_picture(0)
square <- Reduce(`+`, Map(function(p, q) (p - q)^2, a, b))
for (r in names(rings)) {
  m <- rings[[r]]
  put(paste0("pixels.", r), sum(m))
  put(paste0("psnr.", r), 10 * log10(255^2 / (sum(square[m]) / (3 * sum(m)))))
  put(paste0("wpsnr.", r), 10 * log10(255^2 / (sum((weight * square)[m]) / (3 * sum(weight[m])))))
}

# --- SSIM ---
luma <- function(p) 0.299 * p[[1]] + 0.587 * p[[2]] + 0.114 * p[[3]]
window <- outer(-5:5, -5:5, function(i, j) exp(-(i^2 + j^2) / (2 * 1.5^2)))
window <- window / sum(window)
x <- luma(a)
y <- luma(b)
ssim <- matrix(NA, H, W)
for (i in 6:(H - 5)) for (j in 6:(W - 5)) {
  wx <- x[(i - 5):(i + 5), (j - 5):(j + 5)]
  wy <- y[(i - 5):(i + 5), (j - 5):(j + 5)]
  mx <- sum(window * wx)
  my <- sum(window * wy)
  sx <- sum(window * (wx - mx)^2)
  sy <- sum(window * (wy - my)^2)
  sxy <- sum(window * (wx - mx) * (wy - my))
  ssim[i, j] <- (2 * mx * my + 2.55^2) * (2 * sxy + 7.65^2) / ((mx^2 + my^2 + 2.55^2) * (sx + sy + 7.65^2))
}
put_rings("ssim", ssim)

# --- FLIP ---
linear <- function(v) { s <- v / 255; ifelse(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055)^2.4) }
M <- rbind(c(10135552, 8788810, 4435075) / 24577794, c(2613072, 8788810, 887015) / 12288897,
           c(1425312, 8788810, 70074185) / 73733382)
white <- rowSums(M)
apply3 <- function(m, p) lapply(1:3, function(i) m[i, 1] * p[[1]] + m[i, 2] * p[[2]] + m[i, 3] * p[[3]])
xyz_from_rgb <- function(p) apply3(M, p)
ycxcz <- function(p) {
  t <- Map(`/`, xyz_from_rgb(p), white)
  list(116 * t[[2]] - 16, 500 * (t[[1]] - t[[2]]), 200 * (t[[2]] - t[[3]]))
}
rgb_from_ycxcz <- function(p) {
  y <- (p[[1]] + 16) / 116
  apply3(solve(M), Map(`*`, list(y + p[[2]] / 500, y, y - p[[3]] / 200), white))
}
hunt_lab <- function(rgb) {
  f <- function(t) ifelse(t > (6 / 29)^3, t^(1 / 3), t / (3 * (6 / 29)^2) + 4 / 29)
  t <- lapply(Map(`/`, xyz_from_rgb(rgb), white), f)
  L <- 116 * t[[2]] - 16
  list(L, 0.01 * L * 500 * (t[[1]] - t[[2]]), 0.01 * L * 200 * (t[[2]] - t[[3]]))
}
hyab <- function(p, q) abs(p[[1]] - q[[1]]) + sqrt((p[[2]] - q[[2]])^2 + (p[[3]] - q[[3]])^2)
# Convolution, the picture continued by its edges; kernel[j, i]: row and column offset.
convolve2 <- function(p, kernel) {
  r <- (nrow(kernel) - 1) / 2
  out <- matrix(0, nrow(p), ncol(p))
  for (j in -r:r) for (i in -r:r)
    out <- out + kernel[j + r + 1, i + r + 1] *
      p[clamp(1:nrow(p) - j, 1, nrow(p)), clamp(1:ncol(p) - i, 1, ncol(p))]
  out
}
csf <- list(c(1, 0.0047, 0, 1e-5), c(1, 0.0053, 0, 1e-5), c(34.1, 0.04, 13.5, 0.025))
csf_kernel <- function(k, ppd) {
  r <- ceiling(3 * sqrt(0.04 / (2 * pi^2)) * ppd)
  d <- outer(-r:r, -r:r, function(j, i) (i^2 + j^2) / ppd^2)
  g <- k[1] * sqrt(pi / k[2]) * exp(-pi^2 * d / k[2]) + k[3] * sqrt(pi / k[4]) * exp(-pi^2 * d / k[4])
  g / sum(g)
}
features <- function(y, ppd, point) {
  sd <- 0.5 * 0.082 * ppd
  r <- ceiling(3 * sd)
  k <- outer(-r:r, -r:r, function(j, i) {
    g <- exp(-(i^2 + j^2) / (2 * sd^2))
    if (point) (i^2 / sd^2 - 1) * g else -i * g
  })
  k[k > 0] <- k[k > 0] / sum(k[k > 0])
  k[k < 0] <- k[k < 0] / -sum(k[k < 0])
  sqrt(convolve2(y, k)^2 + convolve2(y, t(k))^2)
}
flip <- function(test, reference, ppd) {
  side <- function(p) {
    o <- ycxcz(lapply(p, linear))
    filtered <- Map(function(plane, k) convolve2(plane, csf_kernel(k, ppd)), o, csf)
    lab <- hunt_lab(lapply(rgb_from_ycxcz(filtered), clamp, 0, 1))
    y <- (o[[1]] + 16) / 116
    list(lab = lab, edge = features(y, ppd, FALSE), point = features(y, ppd, TRUE))
  }
  s <- side(test)
  r <- side(reference)
  c_max <- hyab(hunt_lab(list(0, 1, 0)), hunt_lab(list(0, 0, 1)))^0.7
  e <- hyab(s$lab, r$lab)^0.7
  e <- ifelse(e < 0.4 * c_max, 0.95 / (0.4 * c_max) * e,
              0.95 + (e - 0.4 * c_max) / (c_max - 0.4 * c_max) * 0.05)
  f <- sqrt(pmax(abs(s$edge - r$edge), abs(s$point - r$point)) / sqrt(2))
  e^(1 - f)
}
for (ppd in c(1, 5.27, 20, 67.02)) {
  map <- flip(a, b, ppd)
  put_rings(paste0("flip", ppd), map)
  for (i in c(0, 100, 777, 1000, 1500, W * H - 1)) # pixels by row and column
    put(paste0("flip", ppd, ".pixel", i), map[i %/% W + 1, i %% W + 1])
}
solid <- function(r, g, b) lapply(c(r, g, b), function(v) matrix(v, H, W))
put("flip.black_white", flip(solid(0, 0, 0), solid(255, 255, 255), 67.02)[20, 20])
put("flip.green_blue", flip(solid(0, 255, 0), solid(0, 0, 255), 67.02)[20, 20])
put("flip.gray", flip(solid(128, 128, 128), solid(120, 120, 120), 67.02)[20, 20])

# --- flicker along motion: a plane that moves by (0.75, 0.5), a nearer box that moves by (2, 0), a background ---
plane <- function(px, py) 0.2 + 0.002 * px + 0.001 * py # 1 / distance
in_box <- function(t) X >= 16 + 2 * t & X < 28 + 2 * t & Y >= 12 & Y < 24
near <- function(t) ifelse(in_box(t), 0.5, ifelse(Y < 6, 0, plane(X + 0.5, Y + 0.5)))
excess <- c()
for (t in 1:3) {
  px <- X - ifelse(in_box(t), 2, 0.75) # from 0 at the first pixel's centre
  py <- Y - ifelse(in_box(t), 0, 0.5)
  expected <- ifelse(in_box(t), 0.5, ifelse(Y < 6, 0, plane(px + 0.5, py + 0.5)))
  inside <- px >= 0 & py >= 0
  sample <- function(p) {
    x0 <- floor(px); y0 <- floor(py)
    at <- function(dx, dy) matrix(p[cbind(c(clamp(y0 + dy, 0, H - 1)) + 1, c(clamp(x0 + dx, 0, W - 1)) + 1)], H, W)
    fx <- px - x0; fy <- py - y0
    (1 - fy) * ((1 - fx) * at(0, 0) + fx * at(1, 0)) + fy * ((1 - fx) * at(0, 1) + fx * at(1, 1))
  }
  seen <- sample(near(t - 1))
  ok <- inside & abs(seen - expected) <= 0.02 * pmax(seen, expected)
  change <- function(picture) abs(luma(picture(t)) - sample(luma(picture(t - 1))))
  excess <- c(excess, list(list(ok = ok, map = pmax(0, change(test_picture) - change(reference_picture)))))
}
for (r in names(rings)) {
  values <- unlist(lapply(excess, function(e) e$map[e$ok & rings[[r]]]))
  put(paste0("excess.", r), mean(values))
  put(paste0("excess.count.", r), length(values))
}

# --- flicker of a still view: 2 blocks of 16 frames at 90 Hz ---
r_trans <- function(hz) exp(-abs(hz^0.1898 - 5^0.1898)^2 / 0.156257)
for (hz in c(0, 1, 5, 11.25, 45)) put(paste0("r_trans.", hz), r_trans(hz))
luminance <- function(p) { l <- lapply(p, linear); 0.2126 * l[[1]] + 0.7152 * l[[2]] + 0.0722 * l[[3]] }
still <- function(picture, first) {
  series <- sapply(first + 0:15, function(t) c(luminance(picture(t)))) # pixel by time
  power <- Mod(t(apply(series, 1, fft)))^2 / 16^2
  hz <- c(0:8, 7:1) * 90 / 16
  list(deviation = sqrt(rowSums(power[, -1])), weighted = sqrt(power[, -1] %*% r_trans(hz[-1])^2))
}
for (which in c("deviation", "weighted")) {
  map <- (still(test_picture, 0)[[which]] - still(reference_picture, 0)[[which]] +
          still(test_picture, 16)[[which]] - still(reference_picture, 16)[[which]]) / 2
  put_rings(paste0("still.", which), matrix(map, H, W))
}
writeLines(lines, "image_measures.csv")
