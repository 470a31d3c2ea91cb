//! Words that names of columns have.

/// Of times.
pub(super) const TIMES: &str = "\
    t uhrzeit time times zeit zeitstempel timestamp temps tiempo tid tijd tempo datetime clock elapsed время 時間 時刻 时间 \
    시간 epoch epoc";
/// They count.
pub(super) const INDICES: &str = "\
    index idx sample samples n no nr num number row # id count unnamed frame point counter packet packetcounter seq \
    sequence record loopiteration";
pub(super) const ACCELERATIONS: &str = "ax ay az ar beschleunigung shock gforce ускорение 加速度 가속도 versnelling \
    gfx gfy gfz longg latg vertg";
/// Of acceleration in g, as telephones tell it beside one in m/s².
pub(super) const G_FORCES: &str = "gfx gfy gfz";
/// Beside an acceleration they say where it was measured.
pub(super) const PLACES: &str = "height position pos distance displacement";
/// These words name other quantities, which are measured beside an acceleration; a unit of acceleration outweighs them.
pub(super) const OTHERS: &str = "\
    accelerator pedal clutch brake steering gear rpm status range load mag magx magy magz magnetometer sensitivity mass masse weight velocity vel vx vy \
    vz f frequency freq frequenz frecuencia fréquence order period periode eigenperiode quefrency speed force temperature temp voltage current power pressure angular rotation strain magnetic humidity comment \
    trigger roll pitch yaw heading azimuth course battery batt rssi setpoint throttle lat lon lng latitude longitude \
    altitude alt baro wx wy wz omega omegax omegay omegaz qw qx qy qz duration dauer delay latency width flags event marker \
    angle euler gyr";
/// A date beside a time of day.
pub(super) const DATES: &str = "date datum fecha";
/// Words that begin so name what is no acceleration: `gyroX`, `motor[0]`, `vbatLatest`, `quaternion`.
pub(super) const BEGINNINGS: &str = "gyro motor vbat quat magn rcdata baro";
/// In grams and gausses, whose signs are those of gravity.
pub(super) const GRAMS: &str = "tare brutto netto poids peso einwaage füllmenge waage balance dose thrust schub kraft fuel 質量 重量 体重 mass masse weight gewicht magx magy magz mag magnetometer magnetic";
/// These words name functions of accelerations, and bounds: neither is an acceleration.
pub(super) const FUNCTIONS: &str = "\
    log log10 20log 20log10 ln lg db psd asd fft spectrum spectral srs squared square sqrt rms variance jerk cumulative integral \
    inverse reciprocal normalized normalised accuracy uncertainty limit limits grenze grenzwert threshold tolerance \
    stdev sigma kurtosis negated inverted peak max maximum min minimum p2p ptp pp pk pkpk envelope tgf spitzenwert spitze scheitelwert crête hüllkurve effektivwert efficace eff pico rmq std σ \
    varianz abweichung toleranz spektrum psa percentile cumulated modulus abs percent prozent promille mille cent";
/// The same in scripts without blanks: they stand anywhere in a name.
pub(super) const FUNCTIONS_WITHIN: &str = "最大 峰值 ピーク 実効";
/// Before a number these words make a factor of it, or an offset.
pub(super) const FACTORS: &str = "\
    gain div divided divide scale scaled scaling factor faktor mult multiplied multiply multiplier times offset plus \
    minus amp amplification amplified attenuation att coefficient calibration cal slope ratio by per";
/// They tell packets and devices apart, whether they count or not.
pub(super) const DEVICES: &str = "id packet packetcounter";
/// What channel codes of ISO 13499 have in their 13th and 14th place: what they measure, but for AC, an acceleration.
pub(super) const CODED: &str = "aa an av cu cv ds fo im in lo ma me mo pr ro st te ti tp ve vo";
