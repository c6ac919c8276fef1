//! Twist angles as the command line gives them.

/// Twist angles [degrees].
#[derive(Clone)]
pub(super) struct Angles(pub Vec<f64>);

pub(super) const DEFAULT: &str = "0..180:7";
/// Largest angle [degrees], and most angles: more is a slip.
const MOST: f64 = 1e5;

impl Angles {
    pub fn parse(text: &str) -> Result<Self, String> {
        let number = |text: &str| match text.trim().parse::<f64>() {
            Ok(angle) if angle.abs() <= MOST => Ok(angle),
            _ => Err(format!(
                "`{text}` is not an angle in degrees; give a list such as 0,30,60, or 0..180:7 for 7 angles"
            )),
        };
        let Some((from, rest)) = text.split_once("..") else {
            return Ok(Self(text.split(',').map(number).collect::<Result<_, _>>()?));
        };
        let (to, count) = rest
            .split_once(':')
            .ok_or("say how many angles, as in 0..180:7")?;
        let (from, to) = (number(from)?, number(to)?);
        let count = count
            .trim()
            .parse::<u32>()
            .ok()
            .filter(|n| (2..=MOST as u32).contains(n));
        let count = count.ok_or("give 2 angles or more, as in 0..180:7")?;
        let share = |i: u32| f64::from(i) / f64::from(count - 1);
        Ok(Self(
            (0..count).map(|i| from + (to - from) * share(i)).collect(),
        ))
    }
}
