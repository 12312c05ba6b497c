//! Fallback for any processor: plain loops, which the compiler may vectorise.

use super::{HitChildren, Isa, Lanes, Words};

/// Instructions that the program was compiled for.
#[derive(Clone, Copy)]
pub(super) struct Portable;

impl Portable {
    #[inline(always)]
    fn zip(a: Lanes, b: Lanes, f: impl Fn(f32, f32) -> f32) -> Lanes {
        Lanes(std::array::from_fn(|i| f(a.0[i], b.0[i])))
    }

    #[inline(always)]
    fn mask(a: Lanes, b: Lanes, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(f(a.0[i], b.0[i])) << i)
    }
}

impl Isa for Portable {
    type F = Lanes;
    #[inline(always)]
    fn splat(self, value: f32) -> Lanes {
        Lanes([value; 8])
    }
    #[inline(always)]
    fn load(self, from: &Lanes) -> Lanes {
        *from
    }
    #[inline(always)]
    fn load_bits(self, from: &Words) -> Lanes {
        Lanes(from.0.map(f32::from_bits))
    }
    #[inline(always)]
    fn add(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn mul_add(self, a: Lanes, b: Lanes, c: Lanes) -> Lanes {
        self.add(self.mul(a, b), c)
    }
    #[inline(always)]
    fn mul_sub(self, a: Lanes, b: Lanes, c: Lanes) -> Lanes {
        self.sub(self.mul(a, b), c)
    }
    #[inline(always)]
    fn min(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn abs(self, a: Lanes) -> Lanes {
        Lanes(a.0.map(f32::abs))
    }
    #[inline(always)]
    fn xor_sign(self, a: Lanes, sign: Lanes) -> Lanes {
        Self::zip(a, sign, |a, s| f32::from_bits(a.to_bits() ^ (s.to_bits() & 0x8000_0000)))
    }
    #[inline(always)]
    fn select(self, a: Lanes, b: Lanes, by: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|i| if by.0[i].is_sign_negative() { b.0[i] } else { a.0[i] }))
    }
    #[inline(always)]
    fn le(self, a: Lanes, b: Lanes) -> u32 {
        Self::mask(a, b, |a, b| a <= b)
    }
    #[inline(always)]
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must pass")]
    fn not_gt(self, a: Lanes, b: Lanes) -> u32 {
        Self::mask(a, b, |a, b| !(a > b))
    }
    #[inline(always)]
    fn compress_hits(
        self,
        order: u32,
        enter: Lanes,
        leave: Lanes,
        child: &Words,
    ) -> HitChildren<Lanes> {
        let (mut near, mut children) = (Lanes([0.0; 8]), Lanes([0.0; 8]));
        let mut count = 0;
        for place in 0..8 {
            let lane = (order >> (3 * place) & 7) as usize;
            near.0[count] = enter.0[lane];
            children.0[count] = f32::from_bits(child.0[lane]);
            count += usize::from(enter.0[lane] <= leave.0[lane]);
        }
        HitChildren { count, near, children }
    }
    #[inline(always)]
    unsafe fn write(self, value: Lanes, to: *mut u32) {
        // SAFETY: the caller's.
        unsafe { to.cast::<[f32; 8]>().write_unaligned(value.0) };
    }
}
